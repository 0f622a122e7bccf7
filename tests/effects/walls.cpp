// Walls that shake, and walls with glued discs.
#include <numbers>

#include "particles/stepping/run_through.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// A disc on a plate that shakes vertically, z = A sin(rate t), A rate^2 = `acceleration` g.
Scene shaken_plate(double acceleration, double rate) {
  return on_floor({{0, 0.5}})
      .lasting(2 * 2 * std::numbers::pi / rate, 1e-3)
      .moving("floor",
              Oscillation{{0, acceleration / (rate * rate)}, rate / (2 * std::numbers::pi) / time_s, 0});
}

TEST(ShakenPlate, CarriesADiscAlongBelowGravity) {
  const double rate = 2, A = 0.9 / (rate * rate);
  TestRun run(shaken_plate(0.9, rate));
  run.each_step([&] {
    // On the exact place of the plate, at every time, without drift.
    ASSERT_NEAR(run.bodies().z[0], 0.5 + A * std::sin(rate * run.time()), 1e-8);
  });
}

TEST(ShakenPlate, ThrowsADiscUpWhereItFallsFasterThanGravity) {
  // Lift-off where A rate^2 sin(rate t) = g. Then the gap grows as A rate^3 cos(rate t) tau^3 / 6 = 0.37
  // tau^3 and is seen, above 1e-8, after 3e-3 and up to two steps.
  const double rate = 2, acceleration = 1.5, A = acceleration / (rate * rate);
  TestRun run(shaken_plate(acceleration, rate));
  double lifts_at = 0;
  while (lifts_at == 0 && !run.finished()) {
    (void)run.step();
    const double t = run.time();
    if (run.bodies().z[0] > 0.5 + A * std::sin(rate * t) + 1e-8) lifts_at = t;
  }
  EXPECT_NEAR(lifts_at, std::asin(1 / acceleration) / rate, 5e-3);
}

TEST(Shaft, OfExactlyTheWidthOfADiscLetsItFallFreely) {
  // Rounding alone presses the disc against walls: nothing is missed, all stays finite, and it moves as if
  // alone.
  for (const double degrees : {0.0, 30.0, 77.0})
    for (const bool falls : {true, false})
      for (const bool bounces : {true, false}) {
        const double angle = degrees * std::numbers::pi / 180, n_x = std::cos(angle), n_z = std::sin(angle);
        const Point middle{10.0 / 3, 100.1}, along{n_z, -n_x};
        if (falls && degrees > 0) continue;  // a wall would carry it
        TestScene scene =
            scene_of({{middle.x, middle.z, 1, falls ? 0 : 3 * along.x, falls ? 0 : 3 * along.z}})
                .lasting(4, 0.02);
        for (const double side : {-0.5, 0.5}) {
          const Point foot{middle.x + side * n_x, middle.z + side * n_z};
          scene.walls.push_back(segment("shaft", {foot.x - 60 * along.x, foot.z - 60 * along.z},
                                        {foot.x + 60 * along.x, foot.z + 60 * along.z}));
        }
        scene.solver = {};  // a wall that is too near by rounding misses finer tolerances
        if (falls) scene.with(Gravity{});
        if (bounces) scene.with(Restitution{0.5, 0.5});
        TestRun run(scene);
        run.each_step([&](const StepReport& report) {
          ASSERT_TRUE(is_converged(report)) << degrees << falls << bounces;
          ASSERT_LT(report.solve.residual.rms, 1e-2);
          ASSERT_LT(report.solve.residual.max, 1e-1);
          ASSERT_LT(report.solve.residual.sinking, 1e-10);
          ASSERT_LE(report.solve.sweeps, 100);
        });
        const Bodies& bodies = run.bodies();
        EXPECT_NEAR(bodies.v_x[0], falls ? 0 : 3 * along.x, 1e-6);
        EXPECT_NEAR(bodies.v_z[0], falls ? -4 : 3 * along.z, 1e-6);
      }
}

TEST(Rocking, ReachesItsAmplitudeAndComesBackExactly) {
  Walls walls;
  walls.names = {"plate"};
  walls.reference = {Segment{{0, 0}, {1, 0}}};
  walls.wall_of_shape = {0};
  walls.pose_at_start = {Pose{}};
  walls.motions = {{Swinging{0.3, 2 * std::numbers::pi, 0, {0.5, 0}}}};
  const auto end_at = [&](double time) { return std::get<Segment>(walls.shapes_at(time)[0]).to; };
  EXPECT_NEAR(end_at(0.25).x, 0.5 + 0.5 * std::cos(0.3), 1e-14);
  EXPECT_NEAR(end_at(0.25).z, -0.5 * std::sin(0.3), 1e-14);  // clockwise
  EXPECT_NEAR(end_at(1000).x, 1, 1e-10);
  EXPECT_NEAR(end_at(1000).z, 0, 1e-10);
}

TEST(RotatingContainer, GrainOnTheWallTurnsWithItAndDoesNotDrift) {
  const double turns = 10, spin = 0.5;  // centripetal acceleration presses it to the wall
  TestRun run(scene_of({{0, -9.5, 1, -9.5 * spin, 0, spin}})
                  .between({drum_wall(10)})
                  .with(Friction{0.9, 0.9}, Spin{})
                  .lasting(turns * 2 * std::numbers::pi / spin, 0.05)
                  .moving("drum", turning(spin)));
  const Bodies& b = run.bodies();
  double farthest = 0;
  run.each_step([&] { farthest = std::max(farthest, std::abs(std::hypot(b.x[0], b.z[0]) - 9.5)); });
  EXPECT_LT(farthest, 2e-4);
  EXPECT_NEAR(std::hypot(b.v_x[0], b.v_z[0]), 9.5 * spin, 0.01);
  EXPECT_NEAR(b.spin[0], spin, 0.01);
}

TEST(RoughWall, ANumberOfDiscsFitsWholeAroundAContainerAndADisc) {
  // 2 pi 30 / 3 = 62.8: 63 of them; 10 pi / 3.1 = 10.1: 11, their centres on the rim.
  Scene scene = turning_drum();
  scene.walls[0].rough = Roughness{2, 3};
  scene.walls.push_back({"wheel", DiscShape{{2, 3}, 10}, {}, Roughness{2, 3.1}});
  const Scales scales = scales_of(scene);
  const Walls walls = walls_of(scene, scales);
  const double unit = 1e-3 / scales.length_m;
  std::size_t s = 0;
  const auto expect_discs = [&](std::size_t count, const Point& center, double radius, int wall) {
    const std::size_t first = ++s;  // behind the smooth shape
    for (; s < first + count; ++s) {
      const auto& disc = std::get<FixedDisc>(walls.reference.at(s));
      const auto& next = std::get<FixedDisc>(walls.reference.at(s + 1 == first + count ? first : s + 1));
      EXPECT_NEAR(std::hypot(disc.center.x - center.x * unit, disc.center.z - center.z * unit), radius * unit,
                  1e-12);
      EXPECT_NEAR(disc.radius, unit, 1e-12);
      EXPECT_NEAR(std::hypot(next.center.x - disc.center.x, next.center.z - disc.center.z),
                  2 * radius * unit * std::sin(std::numbers::pi / static_cast<double>(count)), 1e-12);
      EXPECT_EQ(walls.wall_of_shape[s], wall);
    }
  };
  expect_discs(63, {0, 0}, 30, 0);
  expect_discs(11, {2, 3}, 5, 1);
  EXPECT_EQ(walls.reference.size(), s);
}

TEST(RoughWall, TurnsGrainsWithoutFriction) {
  // What a smooth frictionless drum cannot do.
  Scene scene = turning_drum();
  scene.effects = {Gravity{}};
  scene.solver.tolerance = 1e-6;  // a smooth drum leaves grains where they are; an inexact solve moves them
  scene.solver.max_sweeps = 10000;
  const auto mean_x = [](const Scene& moving) {
    const Bodies end = bodies_at_end(moving);
    double sum = 0;
    for (const double x : end.x) sum += x;
    return sum / static_cast<double>(end.count());
  };
  Scene resting = scene;
  resting.stages[0].motions.clear();
  // But for the second-order shift (h Omega)^2 R / 2 = 2e-4 d of a wall point that turns within a step.
  EXPECT_NEAR(mean_x(resting), mean_x(scene), 1e-2);
  scene.walls[0].rough = resting.walls[0].rough = Roughness{3, 4};
  EXPECT_GT(std::abs(mean_x(scene) - mean_x(resting)), 0.1);
}

TEST(RoughWall, ClosesOnItselfInAPeriodicDomain) {
  // A floor of the period's length has its discs at one spacing across the seam too: a disc rests there as
  // anywhere.
  TestScene scene = scene_of({{0.01, 0.9}, {6, 0.9}, {-2.41, 0.9}})
                        .between({floor_wall(6)})
                        .with(Gravity{})
                        .lasting(10, 1e-2);
  scene.periodic_x = PeriodicX{-6, 6};
  scene.walls[0].rough = Roughness{1, 1.2};
  const Bodies end = bodies_at_end(scene);
  for (const double z : end.z) EXPECT_NEAR(z, 0.8, 1e-3);
}

}  // namespace
}  // namespace drumlin
