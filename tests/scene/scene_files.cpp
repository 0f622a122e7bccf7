// Reading and writing of scene files; what single keys may hold is the key table's own test.
#include <gtest/gtest.h>

#include <fstream>

#include "particles/scene/scene_file.hpp"
#include "tests/files/folder.hpp"
#include "tests/scene/example.hpp"

namespace drumlin {
using namespace particles;
namespace {

using testing::example_scene;
using testing::replaced;
using testing::scene_problems;

TEST(SceneFile, TurnsBackwardsLastAsLongAsForwards) {
  EXPECT_DOUBLE_EQ(
      duration_s(parse_scene(example_scene, "s.toml", {"stages.1.motions.0.speed_rpm=-60"}).stages[1]), 0.1);
}

TEST(SceneFile, ReadsBackWhatItWritesToTheLastBit) {
  const std::string everything = R"(format = "drumlin-scene-1"
title = "quotes \" and é"
reduced = true
seed = 9223372036854775807
[periodic_x]
x_min_mm = -30.1
x_max_mm = 30.3
[grains]
density_kg_m3 = 0.1
[grains.generated]
count = 3
diameter_min_mm = 0.3333333333333333
diameter_max_mm = 1.1
region = { shape = "rectangle", min_mm = [-3, 0.1], max_mm = [4, 7.7] }
[[walls]]
name = "floor"
shape = "segment"
from_mm = [-30, 0]
to_mm = [30, 0.1]
[[walls]]
name = "knob"
shape = "disc"
center_mm = [10.5, -1]
diameter_mm = 1e-3
[effects.gravity]
direction_deg = -77.7
[effects.restitution]
grain_grain = 0.1
grain_wall = 1
[[stages]]
name = "one"
duration_s = 0.7
time_step_s = 0.0007
snapshots = 3
motions = [{ wall = "floor", kind = "translation", velocity_mm_s = [0.1, -2e-7] }, { wall = "knob", kind = "rotation", speed_rpm = 0.3 }]
[solver]
name = "nlgs"
tolerance = 3e-7
[output]
velocity_window_s = 0.0014
)";
  for (const auto& text : {everything, example_scene}) {
    const std::string resolved = scene_text(parse_scene(text, "s.toml"));
    EXPECT_EQ(scene_text(parse_scene(resolved, "resolved.toml")), resolved);
  }
  const Scene scene = parse_scene(scene_text(parse_scene(everything, "s.toml")), "resolved.toml");
  EXPECT_EQ(scene.seed, 9223372036854775807u);
  EXPECT_EQ(std::get<GeneratedGrains>(scene.grains.source).diameter_min_mm, 0.3333333333333333);
  EXPECT_EQ(std::get<Translation>(scene.stages[0].motions[0].motion).velocity_mm_s[1], -2e-7);
  EXPECT_FALSE(scene.effects.spin);
}

TEST(SceneFile, ReportsEveryProblemAtOnceWithItsPlace) {
  std::string text = replaced(example_scene, "density_kg_m3 = 2700", "density_kg_m3 = -1");
  text = replaced(text, "[effects.gravity]", "[effects.gravty]");
  text = replaced(text, "time_step_s = 1e-3", "time_step_s = \"short\"");
  text = replaced(text, "turns = 0.1", "turns = 0.1\nduration_s = 1");
  text = replaced(text, "wall = \"drum\"", "wall = \"drumm\"");
  std::vector<std::string> found;
  for (const auto& problem : scene_problems(text)) found.push_back(problem.text());
  EXPECT_EQ(found,
            (std::vector<std::string>{
                "s.toml:4:17: grains.density_kg_m3: is -1 (allowed: number in kg/m3, 1e-06 to 1000000)",
                "s.toml:14:1: effects.gravty: is unknown; did you mean \"gravity\"? (allowed: cohesion, "
                "drag, dynamic_friction, friction, gravity, kinetic_friction, "
                "restitution, rolling_resistance, rotating_frame, spin)",
                "s.toml:22:15: stages.0.time_step_s: is a text (allowed: number in s, >= 1e-12)",
                "s.toml:25:9: stages.1.turns: excludes duration_s (allowed: one of the two)",
                "s.toml:29:21: stages.1.motions.0.wall: names no wall: \"drumm\" (allowed: drum)"}));
}

TEST(SceneFile, DoesNotRepeatAProblemAsAContradiction) {
  // The wall has no name, so that the motion cannot find it: one problem, not two.
  const auto text = replaced(example_scene, "name = \"drum\"\n", "");
  expect_has(testing::only_scene_problem(text), "walls.0.name: is missing");
}

TEST(SceneFile, OverridesCountAsTheFile) {
  const Scene read =
      parse_scene(example_scene, "s.toml", {"solver.max_sweeps=50", "output.log_every_steps=7"});
  EXPECT_EQ(read.solver.max_sweeps, 50);
  const std::string title = parse_scene(example_scene, "s.toml").title;
  EXPECT_EQ(read.title, title + " [solver.max_sweeps = 50]");
  EXPECT_EQ(
      testing::only_scene_problem(example_scene, {"solver.max_sweep=50"}),
      "override: solver.max_sweep: is unknown; did you mean \"max_sweeps\"? (allowed: capture_unconverged, "
      "check_every, max_sweeps, name, "
      "penetration_tolerance, projection_share, projection_sweeps, stop_when_unconverged, tolerance)");
}

class ListedGrainsFile : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder;
  std::string scene = replaced(example_scene, R"([grains.generated]
count = 12
diameter_min_mm = 3.0
diameter_max_mm = 3.6
region = { shape = "circle", radius_mm = 15 }
)",
                               "[grains.listed]\nfile = \"list.csv\"\n");
};

TEST_F(ListedGrainsFile, CountsFromTheFolderOfTheScene) {
  folder.with("list.csv", "x_mm,z_mm,diameter_mm\n0,0,3\n");
  const Scene read = read_scene(folder.with("s.toml", scene));
  const auto& file = std::get<ListedGrains>(read.grains.source).file;
  EXPECT_TRUE(file.is_absolute());
  EXPECT_EQ(file, folder / "list.csv");
  // So that the resolved scene means the same wherever it stands.
  EXPECT_EQ(std::get<ListedGrains>(parse_scene(scene_text(read), "/elsewhere/s.toml").grains.source).file,
            file);
}

TEST_F(ListedGrainsFile, IsMissedWithTheKeyThatNamesIt) {
  const auto file = folder.with("s.toml", scene);
  const auto text = message_of<InputError>([&] { read_scene(file); });
  expect_has(text, ":6:8: grains.listed.file");
  expect_has(text, "does not exist");
}

// Found by fuzzing.
TEST_F(ListedGrainsFile, IsMissedWithItsKeyWhereNoFileCanHaveItsName) {
  const auto file = folder.with("s.toml", replaced(scene, "list.csv", std::string(300, 'x')));
  const auto text = message_of<InputError>([&] { read_scene(file); });
  expect_has(text, ":6:8: grains.listed.file");
  expect_has(text, "cannot be found");
}

TEST_F(ListedGrainsFile, ReportsItsProblemsBesideThoseOfTheScene) {
  folder.with("list.csv", "x_mm,z_mm,diameter_mm\n0,0,-3\n");
  const auto file = folder.with("s.toml", replaced(scene, "turns = 0.1", "turns = -1"));
  const auto text = message_of<InputError>([&] { read_scene(file); });
  expect_has(text, "list.csv:2");
  expect_has(text, "stages.1.turns");
}

}  // namespace
}  // namespace drumlin
