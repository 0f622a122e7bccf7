// No grain leaves and nothing becomes NaN without the step saying so. Each case is provoked.
#include <gtest/gtest.h>

#include <limits>

#include "coupling/common/errors.hpp"
#include "tests/support/scenes.hpp"

namespace drumlin {
using namespace particles;
namespace {

using test::add_stage;
using test::Grain;
using test::scene_of;
using test::TemporaryFolder;

/// A row of discs shot to the right; one sweep starts at the foremost and does not come back to it.
std::vector<Grain> shot() {
  std::vector<Grain> row;
  for (int k = 0; k < 8; ++k) row.push_back({4.0 - k, 0, 1, 50});
  return row;
}

Scene hasty(Scene scene) {
  scene.solver.max_sweeps = 1;
  scene.solver.check_every = 1;
  scene.solver.projection_sweeps = 0;
  add_stage(scene, 1, 0.05);
  return scene;
}

std::optional<LostGrain> lost_within(Simulation& simulation, int steps) {
  for (int s = 0; s < steps; ++s)
    if (const auto report = simulation.step(); report.lost) return report.lost;
  return std::nullopt;
}

TEST(LostGrain, ThatLeavesItsContainerIsNamed) {
  const TemporaryFolder folder;
  Scene scene = scene_of(shot(), folder);
  scene.walls = {{"drum", ContainerShape{{0, 0}, 5}}};
  Simulation simulation(hasty(scene));
  const auto lost = lost_within(simulation, 3);
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->how, LostGrain::How::left_container);
  EXPECT_GT(std::hypot(lost->x, lost->z), 5);
}

TEST(LostGrain, NoneGoesThroughASegment) {
  const TemporaryFolder folder;
  Scene scene = scene_of(shot(), folder);
  scene.walls = {{"wall", SegmentShape{{5, -3}, {5, 3}}}};
  Simulation simulation(hasty(scene));
  while (!simulation.finished()) {
    const StepReport report = simulation.step();
    EXPECT_FALSE(report.lost);
    for (const double x : simulation.state().bodies.x) EXPECT_LT(x, 5);
  }
}

TEST(LostGrain, SolvedWellEnoughNoneIsLost) {
  const TemporaryFolder folder;
  Scene scene = scene_of(shot(), folder);
  scene.walls = {{"drum", ContainerShape{{0, 0}, 5}}};
  add_stage(scene, 1, 0.05);
  Simulation simulation(scene);
  EXPECT_FALSE(lost_within(simulation, 20));
}

TEST(LostGrain, PastTheEndOfASegmentIsNoLoss) {
  const TemporaryFolder folder;
  // Passes the tip of the segment at a distance, from one side to the other.
  Scene scene = scene_of({{0, 1, 1, 1.5, -1.5}}, folder);
  scene.walls = {{"wall", SegmentShape{{-3, 0}, {0.2, 0}}}};
  add_stage(scene, 2, 0.01);
  Simulation simulation(scene);
  EXPECT_FALSE(lost_within(simulation, 200));
  EXPECT_LT(simulation.state().bodies.z[0], 0);
}

TEST(LostGrain, WithoutAFiniteEnergyIsNamed) {
  const TemporaryFolder folder;
  Scene scene = scene_of({{-2, 0}, {2, 0}}, folder);
  scene.walls = {{"drum", ContainerShape{{0, 0}, 5}}};
  scene.effects.gravity = Gravity{};
  add_stage(scene, 1, 0.05);
  const SimulationState start = Simulation(scene).state();
  SimulationState state = start;
  state.bodies.z[0] = 1e150;  // a container is everywhere: pushed back at 1e150/h, whose square is no number
  Simulation simulation(scene, state);
  EXPECT_TRUE(lost_within(simulation, 1));
  // And a state that is no number to begin with is no state.
  for (const double wrong :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
    state = start;
    state.bodies.v_x[1] = wrong;
    EXPECT_THROW(Simulation(scene, state), InputError) << wrong;
  }
}

TEST(LostGrain, FirstWithoutAFiniteNumberIsNamed) {
  Bodies bodies;
  for (int k = 0; k < 4; ++k) add_body(bodies, k, 0, 0.5);
  EXPECT_FALSE(grain_that_is_not_finite(bodies));
  bodies.x[2] = std::numeric_limits<double>::quiet_NaN();
  bodies.v_z[3] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(grain_that_is_not_finite(bodies)->grain, 2);
  bodies.x[2] = 0;
  EXPECT_EQ(grain_that_is_not_finite(bodies)->grain, 3);
  bodies.v_z[3] = 0, bodies.spin.assign(4, 0.0), bodies.spin[1] = 1e200;
  EXPECT_EQ(grain_that_is_not_finite(bodies)->grain, 1);
}

}  // namespace
}  // namespace drumlin
