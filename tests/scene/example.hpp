#pragma once
// A short valid scene that the tests of this folder spoil in one way or another.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "particles/scene/scene_file.hpp"
#include "tests/support/says.hpp"
#include "tests/support/scene_text.hpp"

namespace drumlin::testing {
using namespace particles;

/// Line numbers are those of the messages that the tests expect.
inline const std::string example_scene =
    "format = \"drumlin-scene-1\"\ntitle = \"example\"\n" +
    test::generated_grains(12, "{ shape = \"circle\", radius_mm = 15 }") + test::drum_wall() +
    "[effects.gravity]\n" + test::friction("0.4", "0.9") + R"([effects.spin]
[[stages]]
name = "settle"
duration_s = 0.1
time_step_s = 1e-3
[[stages]]
name = "turn"
turns = 0.1
time_step_s = 1e-3
snapshots = 4
motions = [{ wall = "drum", kind = "rotation", speed_rpm = 60 }]
)";

/// `text` with the first `from` replaced by `to`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// The problems of a scene, none for one that is accepted.
inline std::vector<InputProblem> scene_problems(const std::string& text,
                                                const std::vector<std::string>& overrides = {}) {
  try {
    parse_scene(text, "s.toml", overrides);
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

/// The only problem as text; a failure if there are none or more.
inline std::string only_scene_problem(const std::string& text,
                                      const std::vector<std::string>& overrides = {}) {
  const auto problems = scene_problems(text, overrides);
  std::string all;
  for (const auto& problem : problems) all += problem.text() + "\n";
  EXPECT_EQ(problems.size(), 1u) << all;
  return problems.empty() ? "" : problems.front().text();
}

}  // namespace drumlin::testing
