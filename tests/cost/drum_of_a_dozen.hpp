#pragma once
// A scene that takes no time.
#include <string>

namespace drumlin::testing {

inline const std::string drum_of_a_dozen = R"(format = "drumlin-scene-1"
[grains]
density_kg_m3 = 2700
[grains.generated]
count = 12
diameter_min_mm = 3.0
diameter_max_mm = 3.6
region = { shape = "circle", center_mm = [0, -1], radius_mm = 13 }
[[walls]]
name = "drum"
shape = "container"
radius_mm = 15
[effects.gravity]
[effects.friction]
grain_grain = 0.4
grain_wall = 0.9
[effects.spin]
[[stages]]
name = "fall"
duration_s = 0.2
time_step_s = 1e-3
)";

}  // namespace drumlin::testing
