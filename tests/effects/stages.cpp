// What stages change: walls that open, gravity, coefficients, an end before their time.
#include <numbers>

#include "tests/effects/drums.hpp"

namespace drumlin::stages {
using namespace particles;
using namespace test;
namespace {

// Of scene_of with d = 1 mm and 2700 kg/m3.
const double length_m = 1e-3, time_s = std::sqrt(1e-3 / 9.81);

void run_to_end(Simulation& simulation) {
  while (!simulation.finished()) ASSERT_FALSE(simulation.step().lost);
}

/// A disc that slides on a floor at speed 1, without spin: it stops after 1/mu.
Scene sliding_disc(double mu) {
  Scene scene = scene_of({{0, 0.5, 1, 1}});
  scene.walls = {floor_wall()};
  scene.effects = {Gravity{}, Friction{mu, mu}};
  return scene;
}

TEST(TimePlan, TakesNoStepMuchLongerThanTheOneAskedFor) {
  const std::vector<std::pair<double, std::int64_t>> steps_of = {{0.01, 1},  {0.0149, 2}, {0.02, 2},
                                                                 {0.021, 3}, {0.3, 30},   {1.003, 100}};
  for (const auto& [duration, steps] : steps_of) {
    Scene scene = scene_of({{0, 0.5}});
    add_stage(scene, duration, 0.01);
    EXPECT_EQ(time_plan(scene, scales_of(scene)).steps, steps) << duration;
  }
}

TEST(OpenedWall, LetsADiscFallAndKeepsTheNumbersOfTheOthers) {
  const double h = 0.01;
  Scene scene = scene_of({{0, 0.5}});
  scene.walls = {{"gate", SegmentShape{{-2, 0}, {2, 0}}}, {"floor", SegmentShape{{-9, -3}, {9, -3}}}};
  scene.effects.gravity = Gravity{};
  add_stage(scene, 0.5, h);
  add_stage(scene, 1, h);
  add_stage(scene, 9, h);
  scene.stages[0].snapshots = scene.stages[2].snapshots = 1;
  scene.output.velocity_window_s = 0;
  scene.stages[1].opens = {"gate"};
  Simulation simulation(scene);
  while (simulation.state().step < 50) (void)simulation.step();
  const Snapshot before = simulation.take_snapshot();
  ASSERT_EQ(before.contacts.size(), 1u);
  EXPECT_EQ(before.contacts[0].j, -1);
  EXPECT_EQ(before.wall_open, (std::vector<std::int32_t>{0, 0}));
  while (simulation.state().step < 150) (void)simulation.step();
  EXPECT_NEAR(simulation.state().bodies.v_z[0], -1, 1e-9);
  EXPECT_NEAR(simulation.state().bodies.z[0], 0.5 - 0.5, 1e-9);
  run_to_end(simulation);
  const Snapshot after = simulation.take_snapshot();
  ASSERT_EQ(after.contacts.size(), 1u);
  EXPECT_EQ(after.contacts[0].j, -2);
  EXPECT_NEAR(after.z[0], -2.5, 1e-6);
  EXPECT_EQ(after.wall_open, (std::vector<std::int32_t>{1, 0}));
}

TEST(StageGravity, TurnsAndGrowsAtEvenRatesAndStaysAsItIs) {
  const double pi = std::numbers::pi, h = 0.01, T = 4;
  Scene scene = scene_of({{0, 0}});
  scene.effects.gravity = Gravity{};
  add_stage(scene, T, h);
  add_stage(scene, 1, h);
  add_stage(scene, 2, h);
  scene.stages[0].gravity = StageGravity{{}, 0, true};
  scene.stages[2].gravity = StageGravity{3 * 9.81, {}, true};
  Simulation simulation(scene);
  const auto& bodies = simulation.state().bodies;
  const auto to_step = [&](int step) {
    while (simulation.state().step < step) (void)simulation.step();
  };
  // From straight down to the right: the integrals of cos and sin of an angle that grows evenly.
  to_step(400);
  EXPECT_NEAR(bodies.v_x[0], 2 * T / pi, 1e-5);
  EXPECT_NEAR(bodies.v_z[0], -2 * T / pi, 1e-5);
  EXPECT_NEAR(simulation.take_snapshot().gravity_x, 1, 1e-12);
  const double v = bodies.v_x[0];
  to_step(500);
  EXPECT_NEAR(bodies.v_x[0], v + 1, 1e-9);
  // From 1 to 3 within 2: 4 in all, exactly.
  to_step(700);
  EXPECT_NEAR(bodies.v_x[0], v + 1 + 4, 1e-9);
  EXPECT_NEAR(simulation.take_snapshot().gravity_x, 3, 1e-12);
}

TEST(StageCoefficients, HoldInTheirStageAlone) {
  Scene scene = sliding_disc(0.4);
  add_stage(scene, 1, 0.01);
  add_stage(scene, 1, 0.01);
  scene.stages[0].effects.friction = {0, 0};
  Simulation simulation(scene);
  while (simulation.state().step < 100) (void)simulation.step();
  EXPECT_NEAR(simulation.state().bodies.v_x[0], 1, 1e-9);
  run_to_end(simulation);
  EXPECT_NEAR(simulation.state().bodies.v_x[0], 1 - 0.4, 1e-9);
  EXPECT_EQ(simulation.stepper().unknowns_per_contact(), 2);
}

TEST(StageCoefficients, OfRestitutionDecideHowADiscRebounds) {
  for (const double e : {0.25, 1.0}) {
    Scene scene = scene_of({{0, 1, 1, 0, -2}});
    scene.walls = {floor_wall()};
    scene.effects.restitution = Restitution{0.5, 0.5};
    add_stage(scene, 1, 0.01);
    scene.stages[0].effects.restitution = {0, e};
    EXPECT_NEAR(bodies_at_end(scene).v_z[0], 2 * e, 1e-9);
  }
}

/// Slides, stops after 2.5 and has been at rest for 0.5 at 3; then a plain stage.
Scene until_rest() {
  Scene scene = sliding_disc(0.4);
  add_stage(scene, 10, 0.01);
  add_stage(scene, 1, 0.01);
  scene.stages[0].snapshots = 10, scene.stages[1].snapshots = 2;
  scene.stages[1].name = "after";
  scene.stages[0].until = Until{UntilRest{1e-6, 0.5 * time_s}, {}};
  scene.output.velocity_window_s = 0.05 * time_s;
  return scene;
}

TEST(Until, RestEndsAStageAndMovesWhatFollows) {
  Simulation simulation(until_rest());
  std::vector<std::int64_t> taken;
  while (!simulation.finished()) {
    (void)simulation.step();
    if (!simulation.snapshot_due()) continue;
    const Snapshot snapshot = simulation.take_snapshot();
    taken.push_back(snapshot.step);
    EXPECT_NEAR(snapshot.velocity_window, 0.05, 1e-12) << snapshot.step;
    EXPECT_EQ(snapshot.wall_pose_x.size(), 1u);
  }
  // At rest within rounding after step 250, or a little before: kinetic energy 1e-6 is a speed of 1.4e-3.
  ASSERT_EQ(simulation.state().ends.size(), 2u);
  const auto end = simulation.state().ends[0].steps;
  EXPECT_NEAR(end, 300, 2);
  EXPECT_EQ(simulation.state().ends[0].by, EndedBy::rest);
  EXPECT_EQ(simulation.state().ends[1].by, EndedBy::its_time);
  const bool third = end >= 300;  // it may be due at the very end
  std::vector<std::int64_t> expected{100, 200, end, end + 50, end + 100};
  if (third && end > 300) expected.insert(expected.begin() + 2, 300);
  EXPECT_EQ(taken, expected);
  EXPECT_EQ(simulation.plan().steps, end + 100);
  EXPECT_EQ(simulation.state().step, end + 100);
}

TEST(Until, AWallHasMovedEndsAStage) {
  Scene scene = scene_of({{0, 5}});
  scene.walls = {{"lid", SegmentShape{{-2, 20}, {2, 20}}}};
  add_stage(scene, 10, 0.01);
  const double speed = 2 * length_m * 1e3 / time_s;
  scene.stages[0].motions = {{"lid", Translation{{0, -speed}}}};
  scene.stages[0].until = Until{{}, UntilMoved{"lid", 1.005}};  // mm, which is d
  Simulation simulation(scene);
  run_to_end(simulation);
  EXPECT_EQ(simulation.state().step, 51);  // 2 h in a step: the first beyond 1.005
  EXPECT_EQ(simulation.state().ends[0].by, EndedBy::wall);
}

TEST(Stages, AbsentChangesLeaveNoState) {
  const Scene plain = turning_drum();
  Simulation simulation(plain);
  (void)simulation.step();
  const SimulationState& state = simulation.state();
  EXPECT_TRUE(state.ends.empty());
  EXPECT_FALSE(state.gravity);
  EXPECT_FALSE(state.loads);
  EXPECT_TRUE(state.marks.empty());
  EXPECT_TRUE(simulation.walls().open.empty());
  EXPECT_TRUE(simulation.take_snapshot().wall_open.empty());
}

}  // namespace
}  // namespace drumlin::stages
