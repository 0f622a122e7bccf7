// Walls that a force moves against the grains.

#include "coupling/core/basics/errors.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin::driven_walls {
using namespace particles;
using namespace test;
namespace {

/// A column of discs below a piston.
TestScene column(int discs, double strength, double mass, double h) {
  const double top = discs;
  TestScene scene = scene_of(column_of(discs))
                        .between({floor_wall(), segment("piston", {-2, top}, {2, top})})
                        .with(Gravity{}, Friction{0.4, 0.4}, Spin{})
                        .lasting(20 * h, h)
                        .moving("piston", pushed({0, -1}, strength, mass));
  scene.solver.max_sweeps = 50000;
  return scene;
}

TEST(Piston, LoadsAColumnWithExactlyItsForceAndTheWeightsAbove) {
  // From a tenth of a grain's weight to ten thousand, with a light and a heavy piston, one step for all.
  const double h = 0.05;
  for (const double strength : {0.1 * weight, 100 * weight, 1e4 * weight})
    for (const double mass : {0.1, 100.0}) {
      EndedRun run(column(8, strength, mass, h));
      const Snapshot snapshot = run.take_snapshot();
      ASSERT_EQ(snapshot.contacts.size(), 9u);
      for (const auto& c : snapshot.contacts) {
        const double above = c.j == -1 ? 8 : c.j == -2 ? 0 : 8 - std::max(c.i, c.j);
        EXPECT_NEAR(c.impulse_n / h, strength + above * weight, 1e-5 * (strength + 8 * weight))
            << strength << ' ' << mass << ' ' << c.i << ' ' << c.j;
      }
      EXPECT_NEAR(run.state().driven[0].velocity, 0, 1e-6 * std::max(1.0, strength));
    }
}

TEST(Piston, FallsFreelyUntilItTouches) {
  const double h = 0.01, strength = 3, mass = 2;
  Scene scene =
      scene_of({{0, 0.5}})
          .between({segment("piston", {-2, 10}, {2, 10})})
          .lasting(1, h)
          .moving("piston", pushed({0, -2}, strength, mass));  // the length of a direction is nothing
  EndedRun run(scene);
  EXPECT_NEAR(run.state().driven[0].velocity, strength / mass, 1e-9);
  EXPECT_NEAR(run.state().driven[0].position, strength / mass * (1 + h) / 2, 1e-9);
}

TEST(Piston, KeepsTheMomentumOfAnElasticImpact) {
  // Velocities after a central impact of masses M and m: (M - m)/(M + m) and 2 M/(M + m) of the first's.
  const double M = 2, m = weight, v = 1;
  Scene scene = scene_of({{0, 0.5}})
                    .between({segment("piston", {-2, 1.5}, {2, 1.5})})
                    .with(Restitution{1, 1})
                    .lasting(0.1, 0.01)
                    .moving("piston", Translation{{0, -v * mm_s}})
                    .lasting(1, 0.01)  // it keeps its velocity when it is let go
                    .moving("piston", pushed({0, -1}, 0, M));
  EndedRun run(scene);
  EXPECT_NEAR(run.state().driven[0].velocity, (M - m) / (M + m) * v, 1e-9);
  EXPECT_NEAR(run.bodies().v_z[0], -2 * M / (M + m) * v, 1e-9);
}

TEST(Piston, PushedAskewKeepsTheMomentumAlongItsDirection) {
  // A slope free to slide sideways, hit by a falling disc with friction: W_nt is not zero.
  const double M = 1.5, m = weight;
  Scene scene = scene_of({{0, 0.75, 1, 0, -1, 0}})
                    .between({segment("slope", {-3, 3}, {3, -3})})
                    .with(Friction{0.3, 0.3}, Spin{})
                    .lasting(0.3, 0.01)
                    .moving("slope", pushed({1, 0}, 0, M));
  scene.solver.tolerance = 1e-12;
  TestRun run(scene);
  run.each_step([](const StepReport& report) {
    ASSERT_TRUE(report.contacts == 0 || report.solve.status == Status::converged);
  });
  const double slope_v = run.state().driven[0].velocity, disc_v = run.bodies().v_x[0];
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
    const EndedRun run(driven);
    EXPECT_NEAR(run.state().driven[0].position, 0, 1e-12);
    expect_near(bodies_at_end(fixed), run.bodies(), sweeps == 0 ? 1e-7 : 5e-6);
    fixed.stages[0].motions = driven.stages[0].motions;
  }
}

/// Grains between two rough plates, the upper one pressed down and dragged along.
Scene sheared(double pressure) {
  ForceControl lid = pushed({0, -1}, 12 * pressure, 12);
  lid.velocity_mm_s = {mm_s, 0};
  TestScene scene = scene_of(GeneratedGrains{96, 0.9, 1.1, RectangleRegion{{-6, 0.5}, {6, 11}}});
  scene.between({segment("below", {-6, 0}, {6, 0}), segment("above", {-6, 11.6}, {6, 11.6})})
      .with(Friction{0.4, 0.4}, Spin{})
      .lasting(15, 0.02)
      .moving("above", lid);
  for (Wall& wall : scene.walls) wall.rough = Roughness{1, 1};
  scene.periodic_x = PeriodicX{-6, 6};
  scene.solver.tolerance = 1e-6;
  scene.solver.max_sweeps = 2000;
  return scene;
}

TEST(PlaneShear, TheLidCarriesItsPressureInEveryStepButForItsInertia) {
  const double pressure = 2;
  TestRun run(sheared(pressure));
  double carried = 0, below = 0, late = 0;
  while (!run.finished()) {
    const double v = run.state().driven[0].velocity;
    (void)run.step();
    double on_lid = 0, on_floor = 0;
    const auto h = run.plan().stages[0].time_step;
    for (const auto& c : run.stepper().loaded_contacts()) {
      const double up = -(c.normal_z * c.impulse_n - c.normal_x * c.impulse_t);  // on the wall
      if (c.j <= -14) on_lid += up;  // shape 13 is the upper plate, its 12 discs follow
      if (c.j < 0 && c.j > -14) on_floor += up;
    }
    // Newton's law of the lid: M dv = h F - what the grains push up (the normals are stored in float).
    const double change = run.state().driven[0].velocity - v;
    ASSERT_NEAR(12 * change, h * 12 * pressure - on_lid, 1e-5 * (1 + on_lid));
    if (run.time() > 10) carried += on_lid, below -= on_floor, late += h;
  }
  // On average both plates carry the pressure: the lid neither sinks nor rises for long (10 %).
  EXPECT_NEAR(carried / late / 12, pressure, 0.1 * pressure);
  EXPECT_NEAR(below / late / 12, pressure, 0.1 * pressure);
  // Dragged along by one unit of velocity, pressed to a dense layer.
  EXPECT_GT(run.state().driven[0].position, 1);
}

}  // namespace
}  // namespace drumlin::driven_walls
