// The impulses from which a deposited packing starts.
#include "particles/stepping/standing_start.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "particles/scene/placement.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// Ten steps.
Scene box(Placement placement) {
  GeneratedGrains grains{2000, 3.0, 3.6, RectangleRegion{{0, 0}, {100, 400}}};
  grains.placement = placement;
  Scene scene = open_box(grains, 100, 400);
  scene.stages[0].duration_s = 0.01;
  return scene;
}

TEST(StandingStart, TheFloorCarriesTheWeight) {
  const TestRun run(box(Placement::deposited));
  const Bodies& bodies = run.bodies();
  const ImpulseCache& memory = run.state().memory;
  double weight = 0, on_floor = 0, left = 0, right = 0;
  for (const double inverse_mass : bodies.inverse_mass) weight += memory.time_step / inverse_mass;
  for (std::size_t a = 0; a < memory.i.size(); ++a) {
    EXPECT_GE(memory.impulse[2 * a], 0);
    EXPECT_EQ(memory.impulse[2 * a + 1], 0);
    if (memory.j[a] == -1) on_floor += memory.impulse[2 * a];
    if (memory.j[a] == -2) left += memory.impulse[2 * a];
    if (memory.j[a] == -3) right += memory.impulse[2 * a];
  }
  // Of a pressure as in a liquid, where every contact of a layer bears alike: half to once and a half.
  EXPECT_GT(on_floor, 0.5 * weight);
  EXPECT_LT(on_floor, 1.5 * weight);
  EXPECT_NEAR(left, right, 0.3 * left);
}

TEST(StandingStart, SavesSweepsOfTheFirstSteps) {
  const auto sweeps = [](const Scene& scene, bool forget) {
    Simulation started(scene);
    SimulationState state = started.state();
    if (forget) state.memory = {};
    TestRun run(scene, std::move(state));
    int sum = 0;
    while (!run.finished()) sum += run.step().solve.sweeps;
    return sum;
  };
  const Scene scene = box(Placement::deposited);
  EXPECT_LT(2 * sweeps(scene, false), sweeps(scene, true));
}

TEST(StandingStart, IsThatOfDepositedGrainsAlone) {
  EXPECT_TRUE(Simulation(box(Placement::apart)).state().memory.i.empty());
}

}  // namespace
}  // namespace drumlin
