// Walls under a pressure, a force that oscillates, a constant rate of strain; polylines; loads on walls.
#include <numbers>

#include "tests/effects/drums.hpp"

namespace drumlin::servo_walls {
using namespace particles;
using namespace test;
namespace {

// Of scene_of with d = 1 mm and 2700 kg/m3.
const double length_m = 1e-3, time_s = std::sqrt(1e-3 / 9.81);
const double mass_unit = 2700 * length_m * length_m, force_unit = mass_unit * length_m / (time_s * time_s);
const double pressure_unit = force_unit / length_m;
const double weight = std::numbers::pi / 4;  // of a disc of diameter 1

/// Eight discs below a lid of length 4 between two sides, at rest.
Scene column(const PressureControl& lid) {
  std::vector<Grain> grains;
  for (int k = 0; k < 8; ++k) grains.push_back({0, 0.5 + k});
  Scene scene = scene_of(grains);
  scene.walls = {floor_wall(),
                 {"lid", SegmentShape{{-2, 8}, {2, 8}}},
                 {"left", SegmentShape{{-3, 0}, {-3, 8}}},
                 {"right", SegmentShape{{3, 0}, {3, 8}}}};
  scene.effects.gravity = Gravity{};
  add_stage(scene, 1, 0.05);
  scene.stages[0].motions = {{"lid", lid}};
  return scene;
}

double load_on(int wall, const Simulation& simulation) {
  const auto& loads = *simulation.state().loads;
  return loads.walls[wall].impulse_z / loads.time;
}

TEST(Pressure, ActsOnTheLengthOfTheWall) {
  const double p = 2.5;
  Scene scene = column({{0, -1}, p * pressure_unit, 5 * mass_unit});
  scene.output.walls_every_s = 1;  // one interval
  EndedSimulation simulation(scene);
  EXPECT_NEAR(load_on(0, simulation), -(4 * p + 8 * weight), 1e-5);
  EXPECT_NEAR(load_on(1, simulation), 4 * p, 1e-5);
}

TEST(Pressure, ActsOnTheLengthBetweenTwoWallsAsItChanges) {
  // The sides part at speed 1 each: after a time t the length is 6 + 2 t; its mean at the starts of 20 steps.
  const double p = 2.5, mm_s = length_m * 1e3 / time_s;
  PressureControl lid{{0, -1}, p * pressure_unit, 5 * mass_unit};
  lid.between = {"left", "right"};
  Scene scene = column(lid);
  scene.output.walls_every_s = 1;
  scene.stages[0].motions.push_back({"left", Translation{{-mm_s, 0}}});
  scene.stages[0].motions.push_back({"right", Translation{{mm_s, 0}}});
  EndedSimulation simulation(scene);
  EXPECT_NEAR(load_on(1, simulation), p * (6 + 2 * 0.05 * 9.5), 1e-5);
}

TEST(Pressure, OfAPeriodicSceneActsOnThePeriod) {
  Scene scene = column({{0, -1}, pressure_unit, mass_unit});
  scene.periodic_x = PeriodicX{-10, 10};
  scene.walls[1].shape = SegmentShape{{-10.5, 8}, {10.5, 8}};
  EXPECT_NEAR(length_across(walls_of(scene, scales_of(scene)), 1, {0, -1}), 20, 1e-12);
}

TEST(StrainRate, KeepsVelocityOverDistanceAlsoInTheNextStage) {
  const double rate = -0.3;
  Scene scene = scene_of({{50, 50}});
  scene.walls = {{"lid", SegmentShape{{-2, 9}, {2, 9}}}};
  add_stage(scene, 1, 0.01);
  add_stage(scene, 1, 0.01);
  for (Stage& stage : scene.stages) stage.motions = {{"lid", StrainRate{{0, 3}, {7, -1}, rate / time_s}}};
  EndedSimulation simulation(scene);
  const Pose pose = simulation.walls().pose(0, simulation.state().time_in_stage);
  EXPECT_NEAR(9 + pose.z, -1 + 10 * std::exp(2 * rate), 1e-9);
  EXPECT_EQ(pose.x, 0);
}

TEST(WallLoads, HoldMomentumThroughImpactsAndTheTorqueOfAWeight) {
  // A disc dropped to the right of the middle of a floor: in all its impulse is m (g T + v), at its place.
  const double T = 12;
  Scene scene = on_floor({{2, 1.5}});
  scene.effects.restitution = Restitution{0.6, 0.6};
  add_stage(scene, T, 0.01);
  scene.output.walls_every_s = 100;
  EndedSimulation simulation(scene);
  const WallLoads loads = simulation.state().loads.value();
  EXPECT_NEAR(loads.time, T, 1e-9);
  const double impulse = weight * (T + simulation.state().bodies.v_z[0]);
  EXPECT_NEAR(loads.walls[0].impulse_z, -impulse, 1e-9);
  EXPECT_NEAR(loads.walls[0].impulse_x, 0, 1e-12);
  EXPECT_NEAR(loads.walls[0].moment, 2 * impulse, 1e-8);  // clockwise
  EXPECT_TRUE(simulation.wall_loads_due());               // at the end of the run
}

TEST(WallLoads, HoldPlaceAndVelocityOfAWall) {
  const double mm_s = length_m * 1e3 / time_s, h = 0.1;
  Scene scene = scene_of({{50, 50}});
  scene.walls = {{"lid", SegmentShape{{-2, 9}, {4, 9}}}};
  add_stage(scene, 2, h);
  scene.stages[0].motions = {{"lid", Translation{{0, -mm_s}}}};
  scene.output.walls_every_s = 1 * time_s;
  Simulation simulation(scene);
  std::vector<WallLoads> all;
  while (!simulation.finished()) {
    (void)simulation.step();
    if (simulation.wall_loads_due()) all.push_back(simulation.take_wall_loads());
  }
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
  const Simulation simulation(scene);
  const Bodies& bodies = simulation.state().bodies;
  double x = 0, z = 0, mass = 0;
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    const double m = 1 / bodies.inverse_mass[b];
    mass += m, x += m * bodies.v_x[b], z += m * bodies.v_z[b];
  }
  const double speed = 0.07 / simulation.scales().velocity_m_s();
  EXPECT_NEAR(x, 0, 1e-12 * mass * speed);
  EXPECT_NEAR(z, 0, 1e-12 * mass * speed);
  EXPECT_NEAR(kinetic_energy(bodies), mass * speed * speed / 2, 1e-12 * mass * speed * speed);
  expect_same(bodies, Simulation(scene).state().bodies);
  scene.seed = 2;
  EXPECT_NE(bodies.v_x, Simulation(scene).state().bodies.v_x);
}

}  // namespace
}  // namespace drumlin::servo_walls
