// No grain leaves and nothing becomes NaN without the step saying so. Each case is provoked.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "coupling/core/basics/errors.hpp"
#include "tests/files/folder.hpp"
#include "tests/support/scenes.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

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
  Scene scene = scene_of(shot());
  scene.walls = {{"drum", ContainerShape{{0, 0}, 5}}};
  Simulation simulation(hasty(scene));
  const auto lost = lost_within(simulation, 3);
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->how, LostGrain::How::left_container);
  EXPECT_GT(std::hypot(lost->x, lost->z), 5);
}

TEST(LostGrain, NoneGoesThroughASegment) {
  Scene scene = scene_of(shot());
  scene.walls = {{"wall", SegmentShape{{5, -3}, {5, 3}}}};
  Simulation simulation(hasty(scene));
  while (!simulation.finished()) {
    const StepReport report = simulation.step();
    EXPECT_FALSE(report.lost);
    for (const double x : simulation.state().bodies.x) EXPECT_LT(x, 5);
  }
}

TEST(LostGrain, SolvedWellEnoughNoneIsLost) {
  Scene scene = scene_of(shot());
  scene.walls = {{"drum", ContainerShape{{0, 0}, 5}}};
  add_stage(scene, 1, 0.05);
  Simulation simulation(scene);
  EXPECT_FALSE(lost_within(simulation, 20));
}

TEST(LostGrain, PastTheEndOfASegmentIsNoLoss) {
  // Passes the tip of the segment at a distance, from one side to the other.
  Scene scene = scene_of({{0, 1, 1, 1.5, -1.5}});
  scene.walls = {{"wall", SegmentShape{{-3, 0}, {0.2, 0}}}};
  add_stage(scene, 2, 0.01);
  Simulation simulation(scene);
  EXPECT_FALSE(lost_within(simulation, 200));
  EXPECT_LT(simulation.state().bodies.z[0], 0);
}

TEST(LostGrain, WithoutAFiniteEnergyIsNamed) {
  Scene scene = scene_of({{-2, 0}, {2, 0}});
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

/// What a listed start is refused with; empty for one that is accepted.
std::string start_refused(const std::vector<Grain>& grains, double time_step, bool falls = true) {
  Scene scene = scene_of(grains);
  if (falls) scene.effects.gravity = Gravity{};
  add_stage(scene, 100 * time_step, time_step);
  try {
    Simulation{scene};
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

// A listed disc falls by g h^2, 10 d where h = sqrt(10); one of 1e-9 d by as many of its own diameters.
TEST(LongSteps, ListedGrainsFallByADiameterAtMost) {
  EXPECT_EQ(start_refused({{0, 0}}, 0.99), "");
  const std::string ten = start_refused({{0, 0}}, std::sqrt(10.0));
  for (const char* part : {"stages.0.time_step_s: is ", "falls by 10 of the smallest", "allowed: up to "})
    expect_has(ten, part);
  EXPECT_EQ(start_refused({{0, 0}, {2, 0}}, 0.1), "");
  expect_has(start_refused({{0, 0}, {2, 0, 1e-9}}, 0.1), "falls by");
  EXPECT_EQ(start_refused({{0, 0}, {2, 0, 1e-9}}, 0.1, false), "");
}

// Straight ways are swept, however fast: 5 d in a step are none too many, 1100 d are an error.
TEST(LongSteps, ListedGrainsFlyByThousandDiametersAtMost) {
  EXPECT_EQ(start_refused({{0, 0, 1, 50}}, 0.1), "");
  const std::string said = start_refused({{5, 5}, {0, 0, 1, 1.1e4}}, 0.1, false);
  expect_has(said, "in which grain 2 flies by 1.1e+03 mean diameters");
}

TEST(LongSteps, AGrainThatFliesTooFarInARunIsNamed) {
  Scene scene = scene_of({{5, 5}, {0, 0}});
  add_stage(scene, 1, 0.1);
  SimulationState state = Simulation(scene).state();
  state.bodies.v_x[1] = -9000;  // 900 d in a step
  Simulation fast(scene, state);
  EXPECT_FALSE(lost_within(fast, 1));
  state.bodies.v_x[1] = -11000;
  Simulation too_fast(scene, state);
  const auto lost = lost_within(too_fast, 1);
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->grain, 1);
  EXPECT_EQ(lost->how, LostGrain::How::too_fast);
}

// A pressure of 1e4 rho0 g d on some discs far from one another: in ten steps of 0.1 they would pass each
// other.
TEST(LongSteps, APressureThatStrainsACellTooFastEndsTheRun) {
  Scene scene = scene_of({{2, 2}, {7, 2}, {2, 7}, {7, 7}});
  const double unit = 1e3 * scales_of(scene).length_m;
  scene.periodic_x = PeriodicX{0, 10 * unit}, scene.periodic_z = PeriodicZ{0, 10 * unit};
  add_stage(scene, 1, 0.1);
  StageCell cell;
  cell.zz = CellAxis{1e4 * scales_of(scene).stress_Pa()};
  scene.stages[0].cell = cell;
  Simulation simulation(scene);
  const std::string said = message_of<NotConvergedError>([&] { (void)lost_within(simulation, 10); });
  expect_has(said, "the cell is strained by");
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
