// Walls under a pressure, a force that oscillates, a constant rate of strain; polylines; loads on walls.

#include "tests/effects/drums.hpp"

namespace drumlin::servo_walls {
using namespace particles;
using namespace test;
namespace {

/// Eight discs below a lid of length 4 between two sides, at rest.
TestScene column(const PressureControl& lid) {
  return scene_of(column_of(8))
      .between({floor_wall(), segment("lid", {-2, 8}, {2, 8}), segment("left", {-3, 0}, {-3, 8}),
                segment("right", {3, 0}, {3, 8})})
      .with(Gravity{})
      .lasting(1, 0.05)
      .moving("lid", lid);
}

double load_on(int wall, const Simulation& run) {
  const auto& loads = *run.state().loads;
  return loads.walls[wall].impulse_z / loads.time;
}

TEST(Pressure, ActsOnTheLengthOfTheWall) {
  const double p = 2.5;
  Scene scene = column({{0, -1}, p * pressure_unit, 5 * mass_unit});
  scene.output.walls_every_s = 1;  // one interval
  EndedRun run(scene);
  EXPECT_NEAR(load_on(0, run), -(4 * p + 8 * weight), 1e-5);
  EXPECT_NEAR(load_on(1, run), 4 * p, 1e-5);
}

TEST(Pressure, ActsOnTheLengthBetweenTwoWallsAsItChanges) {
  // The sides part at speed 1 each: after a time t the length is 6 + 2 t; its mean at the starts of 20 steps.
  const double p = 2.5;
  PressureControl lid{{0, -1}, p * pressure_unit, 5 * mass_unit};
  lid.between = {"left", "right"};
  Scene scene = column(lid).moving("left", Translation{{-mm_s, 0}}).moving("right", Translation{{mm_s, 0}});
  scene.output.walls_every_s = 1;
  EndedRun run(scene);
  EXPECT_NEAR(load_on(1, run), p * (6 + 2 * 0.05 * 9.5), 1e-5);
}

TEST(Pressure, OfAPeriodicSceneActsOnThePeriod) {
  Scene scene = column({{0, -1}, pressure_unit, mass_unit});
  scene.periodic_x = PeriodicX{-10, 10};
  scene.walls[1].shape = SegmentShape{{-10.5, 8}, {10.5, 8}};
  EXPECT_NEAR(length_across(walls_of(scene, scales_of(scene)), 1, {0, -1}), 20, 1e-12);
}

TEST(StrainRate, KeepsVelocityOverDistanceAlsoInTheNextStage) {
  const double rate = -0.3;
  TestScene scene = scene_of({{50, 50}}).between({segment("lid", {-2, 9}, {2, 9})});
  for (int stage = 0; stage < 2; ++stage)
    scene.lasting(1, 0.01).moving("lid", StrainRate{{0, 3}, {7, -1}, rate / time_s});
  EndedRun run(scene);
  const Pose pose = run.walls().pose(0, run.state().time_in_stage);
  EXPECT_NEAR(9 + pose.z, -1 + 10 * std::exp(2 * rate), 1e-9);
  EXPECT_EQ(pose.x, 0);
}

TEST(WallLoads, HoldMomentumThroughImpactsAndTheTorqueOfAWeight) {
  // A disc dropped to the right of the middle of a floor: in all its impulse is m (g T + v), at its place.
  const double T = 12;
  Scene scene = on_floor({{2, 1.5}}).with(Restitution{0.6, 0.6}).lasting(T, 0.01);
  scene.output.walls_every_s = 100;
  EndedRun run(scene);
  const WallLoads loads = run.state().loads.value();
  EXPECT_NEAR(loads.time, T, 1e-9);
  const double impulse = weight * (T + run.bodies().v_z[0]);
  EXPECT_NEAR(loads.walls[0].impulse_z, -impulse, 1e-9);
  EXPECT_NEAR(loads.walls[0].impulse_x, 0, 1e-12);
  EXPECT_NEAR(loads.walls[0].moment, 2 * impulse, 1e-8);  // clockwise
  EXPECT_TRUE(run.wall_loads_due());                      // at the end of the run
}

TEST(WallLoads, HoldPlaceAndVelocityOfAWall) {
  const double h = 0.1;
  Scene scene = scene_of({{50, 50}})
                    .between({segment("lid", {-2, 9}, {4, 9})})
                    .lasting(2, h)
                    .moving("lid", Translation{{0, -mm_s}});
  scene.output.walls_every_s = 1 * time_s;
  TestRun run(scene);
  std::vector<WallLoads> all;
  run.each_step([&] {
    if (run.wall_loads_due()) all.push_back(run.take_wall_loads());
  });
  ASSERT_EQ(all.size(), 2u);
  for (int k = 0; k < 2; ++k) {
    const WallLoad& load = all[k].walls[0];
    EXPECT_NEAR(all[k].time, 1, 1e-9);
    EXPECT_NEAR(load.place.z, 9 - k - (1 + h) / 2, 1e-9);
    EXPECT_NEAR(load.place.x, 1, 1e-9);
    EXPECT_NEAR(load.last.z - load.first.z, -1, 1e-9);
  }
}

TEST(ThermalMotion, HasNoMomentumAndExactlyItsEnergy) {
  Scene scene = turning_drum();
  scene.grains.thermal_speed_mm_s = 70;
  const TestRun run(scene);
  const Bodies& bodies = run.bodies();
  const double mass = total_mass(bodies), speed = 0.07 / run.scales().velocity_m_s();
  expect_near(momentum(bodies), {}, 1e-12 * mass * speed);
  EXPECT_NEAR(kinetic_energy(bodies), mass * speed * speed / 2, 1e-12 * mass * speed * speed);
  expect_same(bodies, Simulation(scene).state().bodies);
  scene.seed = 2;
  EXPECT_NE(bodies.v_x, Simulation(scene).state().bodies.v_x);
}

}  // namespace
}  // namespace drumlin::servo_walls
