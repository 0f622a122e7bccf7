// For every key of a scene file: another value, and what it changes in a tiny run. A key without a case fails
// the test.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>

#include "particles/scene/scene_file.hpp"
#include "tests/scene/every_key_cases.hpp"
#include "tests/support/scene_text.hpp"

namespace drumlin {
using namespace particles;
namespace testing {
namespace {

/// A dozen grains in a drum that first rests, then turns; every effect.
const std::string drum =
    "format = \"drumlin-scene-1\"\n" +
    test::generated_grains(12, "{ shape = \"circle\", center_mm = [0, -1], radius_mm = 13 }") +
    test::drum_wall() + "center_mm = [0, 0]\n[effects.gravity]\n" + test::friction("0.4", "0.9") +
    R"([effects.restitution]
grain_grain = 0.5
grain_wall = 0.5
[effects.spin]
[[stages]]
name = "fall"
duration_s = 0.05
time_step_s = 1e-3
snapshots = 1
[[stages]]
name = "turn"
turns = 0.1
time_step_s = 1e-3
snapshots = 4
motions = [{ wall = "drum", kind = "rotation", speed_rpm = 60, center_mm = [0, 0] }]
[solver]
name = "nlgs"
tolerance = 1e-6
penetration_tolerance = 1e3
max_sweeps = 200
check_every = 5
[output]
velocity_window_s = 2e-3
)";

/// Eight grains without friction that fall beside two knobs on a floor.
const std::string floor_and_knobs =
    "format = \"drumlin-scene-1\"\n" +
    test::generated_grains(8, "{ shape = \"rectangle\", min_mm = [-8, 1], max_mm = [8, 12] }") +
    R"([[walls]]
name = "floor"
shape = "segment"
from_mm = [-20, 0]
to_mm = [20, 0]
[[walls]]
name = "left"
shape = "disc"
center_mm = [-4, 0]
diameter_mm = 1
[[walls]]
name = "right"
shape = "disc"
center_mm = [4, 0]
diameter_mm = 1
[effects.gravity]
[[stages]]
name = "fall"
duration_s = 0.1
time_step_s = 1e-3
snapshots = 2
motions = [{ wall = "left", kind = "translation", velocity_mm_s = [20, 0] }]
[output]
velocity_window_s = 2e-3
)";

}  // namespace

const std::string& drum_scene() { return drum; }
const std::string& floor_scene() { return floor_and_knobs; }

/// What gtest says of a case that fails.
void PrintTo(const Case& one, std::ostream* out) { *out << one.path << ": " << one.change; }

}  // namespace testing

namespace {

using namespace testing;

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const auto& part :
       {cases_of_the_run(), cases_of_grains(), cases_of_walls(), cases_of_effects(), cases_of_stages(),
        cases_of_stage_changes(), cases_of_servo_walls(), cases_of_cell(), cases_of_traffic()})
    std::copy(part.begin(), part.end(), std::back_inserter(all));
  return all;
}

std::string name_of(const std::string& path, const std::string& condition) {
  return condition.empty() ? path : path + " with " + condition;
}

TEST(EveryKeyTable, HasACase) {
  std::set<std::string> listed, covered;
  for (const auto& row : scene_keys()) listed.insert(name_of(row.path, row.condition));
  for (const auto& one : cases()) covered.insert(name_of(one.path, one.condition));
  for (const auto& key : listed) EXPECT_TRUE(covered.contains(key)) << "no case for " << key;
  for (const auto& key : covered) EXPECT_TRUE(listed.contains(key)) << "no such key: " << key;
}

TEST(EveryKeyTable, TheSameSceneGivesTheSameRun) {
  for (const auto* scene : {&drum_scene(), &floor_scene()}) {
    const auto first = summary_of_run(*scene, {}), second = summary_of_run(*scene, {});
    ASSERT_EQ(first.exit_code, 0);
    ASSERT_FALSE(first.snapshots.empty());
    for (const Observable seen :
         {positions_mm, spins_rad_s, kinetic_energy, logged_sweeps, logged_overlaps, windows_s})
      EXPECT_EQ(seen(first), seen(second));
  }
}

class EveryKey : public ::testing::TestWithParam<Case> {};

TEST_P(EveryKey, ChangesWhatARunLeaves) {
  const Case& one = GetParam();
  std::vector<std::string> changed = one.common;
  changed.push_back(one.change);
  const auto before = summary_of_run(*one.scene, one.common), after = summary_of_run(*one.scene, changed);
  EXPECT_NE(one.seen(before), one.seen(after)) << one.change;
  // A refused scene would differ in everything and prove nothing.
  if (one.seen != exit_code && one.seen != status) {
    EXPECT_EQ(before.status, after.status);
    // A finished run most of whose steps missed a tolerance has another one.
    if (before.status != "finished") {
      EXPECT_EQ(before.exit_code, after.exit_code);
    }
    EXPECT_FALSE(before.log.empty());
    EXPECT_FALSE(after.log.empty()) << one.change << " was refused";
  }
}

INSTANTIATE_TEST_SUITE_P(Scene, EveryKey, ::testing::ValuesIn(cases()), [](const auto& chosen) {
  std::string name = name_of(chosen.param.path, chosen.param.condition);
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
});

}  // namespace
}  // namespace drumlin
