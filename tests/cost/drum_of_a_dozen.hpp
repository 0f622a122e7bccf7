#pragma once
// A scene that takes no time.
#include <string>

#include "tests/support/scene_text.hpp"

namespace drumlin::testing {

inline const std::string drum_of_a_dozen =
    "format = \"drumlin-scene-1\"\n" +
    test::generated_grains(12, "{ shape = \"circle\", center_mm = [0, -1], radius_mm = 13 }") +
    test::drum_wall() + "[effects.gravity]\n" + test::friction("0.4", "0.9") + R"([effects.spin]
[[stages]]
name = "fall"
duration_s = 0.2
time_step_s = 1e-3
)";

}  // namespace drumlin::testing
