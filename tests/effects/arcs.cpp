// Arcs as walls: where discs touch them, how they move, what they do to grains.
#include <algorithm>
#include <limits>
#include <numbers>

#include "particles/bodies/arc.hpp"
#include "particles/detection/contact_list.hpp"
#include "particles/scene/region.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

constexpr double pi = std::numbers::pi;

struct Touch {
  double gap = std::numeric_limits<double>::infinity();
  Point normal, point;
};
/// The nearest of several shapes.
Touch touch_of(const std::vector<Shape>& shapes, Point p, double radius) {
  Touch nearest;
  for (const Shape& shape : shapes) {
    Touch t;
    t.gap = gap_to_shape(shape, p.x, p.z, radius, t.normal.x, t.normal.z, t.point);
    if (t.gap < nearest.gap) nearest = t;
  }
  return nearest;
}

std::vector<Shape> moved_halves(const Pose& pose, const std::array<Arc, 2>& halves) {
  std::vector<Shape> shapes;
  for (const Arc& piece : halves) shapes.push_back(moved(Rigid(pose), Shape(piece)));
  return shapes;
}

TEST(Arc, ADiscThatRollsAlongItTouchesItAllTheWay) {
  // Around all of it: along the outside, around one end, along the inside, around the other. On the path
  // every gap is 0 and the normal that of the path, which has no corner anywhere; with the arc moved and
  // turned as well.
  const Point center{3, -2};
  const double R = 5, r = 0.7, from = -2.8, to = 1.1;
  const auto halves = halves_of(center, R, from, to);
  for (const Pose& pose : {Pose{}, Pose{0.7, 2, -9}, Pose{-2.9, -30, 4}}) {
    const auto shapes = moved_halves(pose, halves);
    const auto expect_touch = [&](double angle, double radial, double tangential) {
      // The end or inner point of the arc, and the direction from it to the disc.
      const double c = std::cos(angle), s = std::sin(angle);
      const Point n{radial * c - tangential * s, radial * s + tangential * c};
      const Point point{center.x + R * c, center.z + R * s};
      const Point disc = moved(pose, {point.x + r * n.x, point.z + r * n.z});
      const Touch touch = touch_of(shapes, disc, r);
      const Point expected = Rigid(pose).turned(n), at_wall = moved(pose, point);
      ASSERT_NEAR(touch.gap, 0, 1e-12) << angle;
      expect_near(touch.normal, expected, 1e-12);
      expect_near(touch.point, at_wall, 1e-12);
    };
    for (int k = 0; k <= 1000; ++k) {
      const double share = k / 1000.0, angle = from + share * (to - from), around = pi * share;
      expect_touch(angle, 1, 0);
      expect_touch(angle, -1, 0);
      expect_touch(to, std::cos(around), std::sin(around));
      expect_touch(from, std::cos(around), -std::sin(around));
    }
  }
}

TEST(Arc, ADiscThatIsTooLargeForItRestsOnBothEnds) {
  const auto shapes = moved_halves({}, halves_of({0, 0}, 1, pi, 2 * pi));
  // Radius 2 on ends 2 apart: its centre is sqrt(3) above them, and both halves touch.
  int touching = 0;
  for (const Shape& shape : shapes) touching += std::abs(touch_of({shape}, {0, std::sqrt(3)}, 2).gap) < 1e-12;
  EXPECT_EQ(touching, 2);
}

TEST(Arc, ReachesAsFarAsItsPoints) {
  for (int k = 0; k < 40; ++k) {
    const double from = -3 + 0.16 * k, to = from + 0.4 + 0.03 * k;
    for (const Arc& piece : halves_of({1, 2}, 3, from, to)) {
      double x_low = 1e9, x_high = -1e9, z_low = 1e9, z_high = -1e9;
      for (int p = -100; p <= 2000; ++p) {
        const Point point = at(piece, piece.turn * p / 2000.0);
        x_low = std::min(x_low, point.x), x_high = std::max(x_high, point.x);
        z_low = std::min(z_low, point.z), z_high = std::max(z_high, point.z);
      }
      const Reaches reach = reaches_of(piece);
      EXPECT_NEAR(reach.x_low, x_low, 1e-6);
      EXPECT_NEAR(reach.x_high, x_high, 1e-6);
      EXPECT_NEAR(reach.z_low, z_low, 1e-6);
      EXPECT_NEAR(reach.z_high, z_high, 1e-6);
    }
  }
}

/// A disc of diameter 1 in a bowl of radius 10 about the origin, pushed aside by an angle.
TestScene bowl(double angle, bool rolls, double duration) {
  TestScene scene = scene_of({{9.5 * std::sin(angle), -9.5 * std::cos(angle)}})
                        .between({{"bowl", ArcShape{{0, 0}, 10, -160, -20}}})
                        .with(Gravity{})
                        .lasting(duration, 2e-3);
  return rolls ? scene.with(Friction{1, 1}, Spin{}) : scene;
}

TEST(Arc, IsABowlInWhichADiscSwingsAsAPendulum) {
  // Sliding: 2 pi sqrt(l) with l = 9.5; rolling: a disc's 3/2 of l; both times 1 + angle^2/16.
  for (const bool rolls : {false, true}) {
    const double angle = 0.2, period = 2 * pi * std::sqrt(9.5 * (rolls ? 1.5 : 1)) * (1 + angle * angle / 16);
    TestRun run(bowl(angle, rolls, period));
    EXPECT_EQ(run.walls().reference.size(), 2u);
    double first_zero = 0;
    run.each_step([&] {
      const Bodies& b = run.bodies();
      ASSERT_NEAR(std::hypot(b.x[0], b.z[0]), 9.5, 1e-5);
      if (first_zero == 0 && b.x[0] < 0) first_zero = run.time();
    });
    EXPECT_NEAR(first_zero, period / 4, 2e-3 * period) << rolls;
    EXPECT_NEAR(run.bodies().x[0], 9.5 * std::sin(angle), 0.01) << rolls;
  }
}

TEST(Arc, IsLeftAtItsEndWithoutAJolt) {
  // A cap that ends 30 degrees from its top: the disc flies on with the velocity that it has there.
  const double R = 10.5, start = 0.1, end = pi / 6;
  TestRun run(scene_of({{R * std::sin(start), R * std::cos(start)}})
                  .between({{"cap", ArcShape{{0, 0}, 10, 60, 120}}})
                  .with(Gravity{})
                  .lasting(12, 1e-3));
  double energy = R * std::cos(start), turned = 0;
  Point before{};
  run.each_step([&] {
    const Bodies& b = run.bodies();
    const Point v{b.v_x[0], b.v_z[0]};
    if (b.z[0] < 0) return;
    ASSERT_NEAR(b.z[0] + (v.x * v.x + v.z * v.z) / 2, energy, 5e-3);
    // No step changes the velocity by more than gravity and the curvature of the cap do.
    ASSERT_LT(std::hypot(v.x - before.x, v.z - before.z), 3e-3);
    before = v;
    if (turned == 0 && b.x[0] > R * std::sin(end)) turned = std::atan2(-v.z, v.x);
  });
  EXPECT_NEAR(turned, end, 2e-3);
}

TEST(Arc, ThatTurnsMovesADiscByFriction) {
  // Steady in a bowl that turns about its centre: the disc spins on its place, at the bottom, with the wall's
  // speed.
  TestScene scene = bowl(0, true, 4).moving("bowl", turning(0.1));  // the wall's speed is 1
  scene.walls[0].shape = ArcShape{{0, 0}, 10, -269, 89};
  const Bodies b = bodies_at_end(scene);
  // Rolls on the wall: v + spin r is the wall's speed there, -1 (clockwise at the bottom).
  const double c = -b.z[0] / 9.5, s = b.x[0] / 9.5, along = b.v_x[0] * c + b.v_z[0] * s;
  EXPECT_NEAR(along - 0.5 * b.spin[0], -1, 1e-3);
}

TEST(ArcsAndPolylines, KeepAGasInsideAndLoseNoEnergy) {
  TestScene scene = scene_of(GeneratedGrains{40, 0.8, 1.2, RectangleRegion{{-4.5, -4.5}, {4.5, 4.5}}});
  scene.with(Restitution{1, 1}).lasting(0.5 / time_s, 2e-4 / time_s);
  scene.grains.thermal_speed_mm_s = 500;
  // Two bowls that overlap: a lens with sharp corners, in which an arc of the one goes on beyond the other.
  const std::vector<Wall> lens = {{"lens", ArcShape{{-6, 0}, 14, -70, 70}},
                                  {"lens", ArcShape{{6, 0}, 14, 110, 250}}};
  PolylineShape star;  // with reentrant corners
  for (int k = 0; k < 10; ++k) {
    const double r = k % 2 == 0 ? 16 : 9, angle = pi * k / 5 + 0.1;
    star.x_mm.push_back(r * std::cos(angle)), star.z_mm.push_back(r * std::sin(angle));
  }
  star.closed = true;
  for (const auto& walls : {lens, {{"star", star}}}) {
    scene.walls = walls;
    TestRun run(scene);
    if (walls.size() == 1) {
      EXPECT_EQ(run.walls().reference.size(), 10u);
    }
    const double before = run.kinetic(), d = run.scales().length_m * 1e3;
    while (!run.finished()) ASSERT_FALSE(run.step().lost);
    const Bodies& bodies = run.bodies();
    for (std::size_t b = 0; b < bodies.count(); ++b)
      if (walls.size() == 1)
        ASSERT_LT(std::hypot(bodies.x[b], bodies.z[b]), 16);
      else
        for (const double side : {-6.0, 6.0})
          ASSERT_LT(std::hypot(bodies.x[b] - side / d, bodies.z[b]), 14 / d);
    EXPECT_NEAR(kinetic_energy(bodies), before, 0.02 * before);
  }
}

TEST(Arc, CrossesRegionsThatItEnters) {
  const RectangleRegion box{{-1, -1}, {1, 1}};
  const CircleRegion disc{{0, 0}, 1};
  const auto crossed = [](const Region& region, const ArcShape& arc) { return crosses(region, arc, 1e-9); };
  for (const Region& region : {Region{box}, Region{disc}}) {
    EXPECT_FALSE(crossed(region, {{0, 0}, 2, 0, 359}));     // around it
    EXPECT_TRUE(crossed(region, {{0, 0}, 0.5, 10, 20}));    // within it
    EXPECT_TRUE(crossed(region, {{3, 0}, 2.5, 170, 190}));  // bulges in
    EXPECT_FALSE(crossed(region, {{3, 0}, 2.5, -90, 90}));  // the other half of it
    EXPECT_FALSE(crossed(region, {{3, 0}, 2, 0, 359}));     // lies against it
    EXPECT_TRUE(crossed(region, {{3, 0}, 2.9, -200, 90}));  // over the zero of the angles
  }
}

}  // namespace
}  // namespace drumlin
