// Walls that a force moves against the grains.
#include <numbers>

#include "coupling/core/basics/errors.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin::driven_walls {
using namespace particles;
using namespace test;
namespace {

// Of scene_of with d = 1 mm and 2700 kg/m3.
const double length_m = 1e-3, time_s = std::sqrt(1e-3 / 9.81);
const double mass_unit = 2700 * length_m * length_m, force_unit = mass_unit * length_m / (time_s * time_s);
const double weight = std::numbers::pi / 4;  // of a disc of diameter 1

/// A force in units of the simulation.
ForceControl force(double x, double z, double strength, double mass) {
  return {{x, z}, strength * force_unit, mass * mass_unit};
}

/// A column of discs below a piston.
Scene column(int discs, double strength, double mass, double h) {
  std::vector<Grain> grains;
  for (int k = 0; k < discs; ++k) grains.push_back({0, 0.5 + k});
  Scene scene = scene_of(grains);
  const double top = discs;
  scene.walls = {floor_wall(), {"piston", SegmentShape{{-2, top}, {2, top}}}};
  scene.effects = {Gravity{}, Friction{0.4, 0.4}, std::nullopt, Spin{}};
  scene.solver.max_sweeps = 50000;
  add_stage(scene, 20 * h, h);
  scene.stages[0].motions = {{"piston", force(0, -1, strength, mass)}};
  return scene;
}

TEST(Piston, LoadsAColumnWithExactlyItsForceAndTheWeightsAbove) {
  // From a tenth of a grain's weight to ten thousand, with a light and a heavy piston, one step for all.
  const double h = 0.05;
  for (const double strength : {0.1 * weight, 100 * weight, 1e4 * weight})
    for (const double mass : {0.1, 100.0}) {
      EndedSimulation simulation(column(8, strength, mass, h));
      const Snapshot snapshot = simulation.take_snapshot();
      ASSERT_EQ(snapshot.contacts.size(), 9u);
      for (const auto& c : snapshot.contacts) {
        const double above = c.j == -1 ? 8 : c.j == -2 ? 0 : 8 - std::max(c.i, c.j);
        EXPECT_NEAR(c.impulse_n / h, strength + above * weight, 1e-5 * (strength + 8 * weight))
            << strength << ' ' << mass << ' ' << c.i << ' ' << c.j;
      }
      EXPECT_NEAR(simulation.state().driven[0].velocity, 0, 1e-6 * std::max(1.0, strength));
    }
}

TEST(Piston, FallsFreelyUntilItTouches) {
  const double h = 0.01, strength = 3, mass = 2;
  Scene scene = scene_of({{0, 0.5}});
  scene.walls = {{"piston", SegmentShape{{-2, 10}, {2, 10}}}};
  add_stage(scene, 1, h);
  scene.stages[0].motions = {
      {"piston", force(0, -2, strength, mass)}};  // the length of a direction is nothing
  EndedSimulation simulation(scene);
  EXPECT_NEAR(simulation.state().driven[0].velocity, strength / mass, 1e-9);
  EXPECT_NEAR(simulation.state().driven[0].position, strength / mass * (1 + h) / 2, 1e-9);
}

TEST(Piston, KeepsTheMomentumOfAnElasticImpact) {
  // Velocities after a central impact of masses M and m: (M - m)/(M + m) and 2 M/(M + m) of the first's.
  const double M = 2, m = weight, v = 1;
  Scene scene = scene_of({{0, 0.5}});
  scene.walls = {{"piston", SegmentShape{{-2, 1.5}, {2, 1.5}}}};
  scene.effects.restitution = Restitution{1, 1};
  add_stage(scene, 0.1, 0.01);
  add_stage(scene, 1, 0.01);
  scene.stages[1].name = "free";
  // It glides at first and keeps that velocity when it is let go.
  scene.stages[0].motions = {{"piston", Translation{{0, -v * length_m * 1e3 / time_s}}}};
  scene.stages[1].motions = {{"piston", force(0, -1, 0, M)}};
  EndedSimulation simulation(scene);
  EXPECT_NEAR(simulation.state().driven[0].velocity, (M - m) / (M + m) * v, 1e-9);
  EXPECT_NEAR(simulation.state().bodies.v_z[0], -2 * M / (M + m) * v, 1e-9);
}

TEST(Piston, PushedAskewKeepsTheMomentumAlongItsDirection) {
  // A slope free to slide sideways, hit by a falling disc with friction: W_nt is not zero.
  const double M = 1.5, m = weight;
  Scene scene = scene_of({{0, 0.75, 1, 0, -1, 0}});
  scene.walls = {{"slope", SegmentShape{{-3, 3}, {3, -3}}}};
  scene.effects.friction = Friction{0.3, 0.3};
  scene.effects.spin = Spin{};
  scene.solver.tolerance = 1e-12;
  add_stage(scene, 0.3, 0.01);
  scene.stages[0].motions = {{"slope", force(1, 0, 0, M)}};
  Simulation simulation(scene);
  while (!simulation.finished()) {
    const StepReport report = simulation.step();
    ASSERT_TRUE(report.contacts == 0 || report.solve.status == Status::converged);
  }
  const double slope_v = simulation.state().driven[0].velocity, disc_v = simulation.state().bodies.v_x[0];
  EXPECT_LT(slope_v, -0.1);  // it gives way
  EXPECT_NEAR(M * slope_v + m * disc_v, 0, 1e-9);
}

TEST(Piston, OfHugeMassIsAFixedWall) {
  Scene fixed = column(5, 0, 1e12, 0.02);
  fixed.walls[1].shape = SegmentShape{{-2, 4.99}, {2, 5.01}};  // askew: it squeezes the column a little
  // The projection sweeps the contacts of driven walls last and ends at a twentieth of the overlap: places
  // agree to that alone. Without it they agree to the residual.
  for (const int sweeps : {0, fixed.solver.projection_sweeps}) {
    fixed.solver.projection_sweeps = sweeps;
    Scene driven = fixed;
    fixed.stages[0].motions.clear();
    const Bodies a = bodies_at_end(fixed);
    EndedSimulation simulation(driven);
    const Bodies& b = simulation.state().bodies;
    EXPECT_NEAR(simulation.state().driven[0].position, 0, 1e-12);
    for (std::size_t k = 0; k < a.count(); ++k) {
      EXPECT_NEAR(a.x[k], b.x[k], sweeps == 0 ? 1e-7 : 5e-6);
      EXPECT_NEAR(a.z[k], b.z[k], sweeps == 0 ? 1e-7 : 5e-6);
    }
    fixed.stages[0].motions = driven.stages[0].motions;
  }
}

/// Grains between two rough plates, the upper one pressed down and dragged along.
Scene sheared(double pressure) {
  Scene scene;
  scene.grains.density_kg_m3 = 2700;
  scene.grains.source = GeneratedGrains{96, 0.9, 1.1, RectangleRegion{{-6, 0.5}, {6, 11}}};
  scene.periodic_x = PeriodicX{-6, 6};
  scene.walls = {{"below", SegmentShape{{-6, 0}, {6, 0}}, {}, Roughness{1, 1}},
                 {"above", SegmentShape{{-6, 11.6}, {6, 11.6}}, {}, Roughness{1, 1}}};
  scene.effects = {std::nullopt, Friction{0.4, 0.4}, std::nullopt, Spin{}};
  scene.solver.tolerance = 1e-6;
  scene.solver.max_sweeps = 2000;
  add_stage(scene, 15, 0.02);
  ForceControl lid = force(0, -1, 12 * pressure, 12);
  lid.velocity_mm_s = {1 / time_s, 0};
  scene.stages[0].motions = {{"above", lid}};
  return scene;
}

TEST(PlaneShear, TheLidCarriesItsPressureInEveryStepButForItsInertia) {
  const double pressure = 2;
  Simulation simulation(sheared(pressure));
  double carried = 0, below = 0, late = 0;
  while (!simulation.finished()) {
    const double v = simulation.state().driven[0].velocity;
    (void)simulation.step();
    double on_lid = 0, on_floor = 0;
    const auto h = simulation.plan().stages[0].time_step;
    for (const auto& c : simulation.stepper().loaded_contacts()) {
      const double up = -(c.normal_z * c.impulse_n - c.normal_x * c.impulse_t);  // on the wall
      if (c.j <= -14) on_lid += up;  // shape 13 is the upper plate, its 12 discs follow
      if (c.j < 0 && c.j > -14) on_floor += up;
    }
    // Newton's law of the lid: M dv = h F - what the grains push up (the normals are stored in float).
    const double change = simulation.state().driven[0].velocity - v;
    ASSERT_NEAR(12 * change, h * 12 * pressure - on_lid, 1e-5 * (1 + on_lid));
    if (simulation.state().time() > 10) carried += on_lid, below -= on_floor, late += h;
  }
  // On average both plates carry the pressure: the lid neither sinks nor rises for long (10 %).
  EXPECT_NEAR(carried / late / 12, pressure, 0.1 * pressure);
  EXPECT_NEAR(below / late / 12, pressure, 0.1 * pressure);
  // Dragged along by one unit of velocity, pressed to a dense layer.
  EXPECT_GT(simulation.state().driven[0].position, 1);
}

TEST(DrivenWall, CostsNothingWhereThereIsNone) {
  const Scene plain = turning_drum();
  const Simulation simulation(plain);
  EXPECT_TRUE(simulation.state().driven.empty());
  const Scales scales = scales_of(plain);
  Walls walls = walls_of(plain, scales);
  begin_stage(walls, plain.stages[0], scales, 0);
  const WallStep step = wall_step(walls, 0, 0.01);
  EXPECT_TRUE(step.driven.empty());
  EXPECT_TRUE(step.driven_of_shape.empty());
}

}  // namespace
}  // namespace drumlin::driven_walls
