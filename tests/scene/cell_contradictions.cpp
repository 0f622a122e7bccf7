// What validate() finds in scenes with a cell that is periodic in x and z.
#include "tests/scene/example.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
using namespace testing;
using namespace particles;
namespace {

const std::string cell =
    "format = \"drumlin-scene-1\"\n"
    "periodic_x = { x_min_mm = 0, x_max_mm = 20 }\n"
    "periodic_z = { z_min_mm = 0, z_max_mm = 20 }\n" +
    test::generated_grains(8, "{ shape = \"rectangle\", min_mm = [0, 0], max_mm = [20, 20] }") +
    "[[stages]]\nname = \"shear\"\nduration_s = 0.1\ntime_step_s = 1e-3\ncell = { shear_rate_per_s = 1 }\n";

TEST(CellContradiction, NoneWithoutWalls) { EXPECT_TRUE(scene_problems(cell).empty()); }

TEST(CellContradiction, WhatNothingHoldsOrNothingMoves) {
  expect_problem(cell, {"effects.gravity={}"}, "effects.gravity", "for ever");
  expect_problem(cell, {"walls=[{name=\"floor\", shape=\"segment\", from_mm=[0, -5], to_mm=[20, -5]}]"},
                 "walls", "periodic in x and z");
  expect_problem(cell, {"periodic_z.z_max_mm=10", "grains.generated.region.max_mm=[20, 10]"},
                 "periodic_z.z_max_mm", "3 of the largest grains");
  expect_problem(cell, {"grains.generated.region.max_mm=[20, 21]"}, "grains.generated.region",
                 "inside the cell");
  expect_problem(cell, {"stages.0.cell={}"}, "stages.0.cell", "nothing that moves");
  expect_problem(cell, {"stages.0.cell={xx={}}"}, "stages.0.cell.xx", "either pressure_n_m2 or rate_per_s");
  expect_problem(cell, {"stages.0.cell={zz={pressure_n_m2=1, rate_per_s=1}}"}, "stages.0.cell.zz", "both");
  expect_problem(cell, {"stages.0.cell={zz={pressure_n_m2=1}}", "solver.capture_unconverged=1"},
                 "solver.capture_unconverged", "under pressure");
  expect_problem(cell, {"effects.drag={rate_per_s=1}"}, "effects.drag", "a moving cell flows");
}

// 0.2 of strain in a step of 1 ms, whatever strains the cell.
TEST(CellContradiction, StrainsOfAStepHaveALimit) {
  const std::string key = "stages.0.cell";
  expect_problem(cell, {key + ".shear_rate_per_s=500"}, key + ".shear_rate_per_s",
                 "is 500, a strain of 0.5 in a step of 0.001 s (allowed: up to 200");
  expect_problem(cell, {key + ".shear_rate_per_s=-12000"}, key + ".shear_rate_per_s",
                 "a strain of 12 in a step");
  expect_problem(cell, {key + ".xx={rate_per_s=201}"}, key + ".xx.rate_per_s", "up to 200");
  expect_problem(cell, {key + ".zz={rate_per_s=-201}"}, key + ".zz.rate_per_s", "up to 200");
  EXPECT_TRUE(scene_problems(cell, {key + ".shear_rate_per_s=200"}).empty());
}

TEST(CellContradiction, CellsThatAreNone) {
  const std::string open = replaced(cell, "periodic_z = { z_min_mm = 0, z_max_mm = 20 }\n", "");
  const auto problem = only_scene_problem(open);
  expect_has(problem, "periodic_x and periodic_z");
  const std::string tube = replaced(cell, "periodic_x = { x_min_mm = 0, x_max_mm = 20 }\n", "");
  expect_has(only_scene_problem(tube), "without periodic_x");
}

}  // namespace
}  // namespace drumlin
