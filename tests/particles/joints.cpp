// Ends of thin walls at which another wall goes on.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "particles/bodies/arc.hpp"
#include "particles/detection/contact_list.hpp"
#include "tests/support/scenes.hpp"

namespace drumlin::particles {
namespace {

struct Touch {
  double gap = 0, n_x = 0, n_z = 0;
};
Touch touch(const Shape& shape, double x, double z) {
  Touch t;
  Point point;
  t.gap = gap_to_shape(shape, x, z, 0.5, t.n_x, t.n_z, point);
  return t;
}

/// A floor from the left to the origin, and a wall that rises by an angle from there to the right.
std::array<Shape, 2> joint(double angle) {
  std::array<Shape, 2> shapes{Segment{{-5, 0}, {0, 0}},
                              Segment{{0, 0}, {5 * std::cos(angle), 5 * std::sin(angle)}}};
  const std::array<int, 2> together{0, 0};
  join_ends(shapes, together);
  return shapes;
}

TEST(Joint, OfAFlatFloorIsNoCorner) {
  const auto [left, right] = joint(0);
  EXPECT_TRUE(std::isinf(touch(right, -0.1, 0.5).gap));
  EXPECT_TRUE(std::isinf(touch(left, 0.1, 0.5).gap));
  EXPECT_NEAR(touch(left, -0.1, 0.5).gap, 0, 1e-15);
  EXPECT_NEAR(touch(right, 0.1, 0.5).gap, 0, 1e-15);
}

TEST(Joint, ThatIsConcaveHasTheLinesOfBothWalls) {
  const double angle = 0.1;
  const auto [left, right] = joint(angle);
  const Touch ahead = touch(right, -0.2, 0.5);  // beside the floor, before the slope
  EXPECT_NEAR(ahead.gap, 0.2 * std::sin(angle) + 0.5 * std::cos(angle) - 0.5, 1e-15);
  EXPECT_NEAR(ahead.n_x, -std::sin(angle), 1e-15);
  EXPECT_NEAR(ahead.n_z, std::cos(angle), 1e-15);
  EXPECT_TRUE(std::isinf(touch(right, -0.2, -0.5).gap));  // from below it is convex
}

TEST(Joint, ThatIsConvexIsACornerBetweenTheNormalsAlone) {
  const auto [left, right] = joint(-1);
  EXPECT_TRUE(std::isinf(touch(right, -0.01, 0.5).gap));
  const double half = 0.5;  // rad, between the normals
  for (const Shape& shape : {left, right}) {
    const Touch t = touch(shape, 0.6 * std::sin(half), 0.6 * std::cos(half));
    EXPECT_NEAR(t.gap, 0.1, 1e-15);
    EXPECT_NEAR(t.n_x, std::sin(half), 1e-15);
  }
}

TEST(Joint, ThatIsConcaveBehindTheOtherWallIsNotFeltThere) {
  // The edge of a floor from which a wall leads back below it, as in the neck of an hourglass: the line of
  // the wall goes on through the discs on the floor.
  const auto [left, right] = joint(-2.2);
  EXPECT_TRUE(std::isinf(touch(right, -0.2, 0.5).gap));
  EXPECT_NEAR(touch(left, -0.2, 0.5).gap, 0, 1e-15);
}

/// Overlap of discs that come to a joint at 0.35 d a step, from many sides.
struct FastDiscs {
  double deepest = 0;          ///< of a disc and a wall, d
  double largest_overlap = 0;  ///< as steps report it
  int unknown_sinkings = 0;    ///< steps that report no number
};
FastDiscs fast_discs_at(double angle, double e) {
  const double speed = 10, step = 0.035, far = 50;
  const Point end{far * std::cos(angle), far * std::sin(angle)};
  FastDiscs all;
  for (int k = 0; k < 80; ++k) {
    const double down = 0.05 + 0.18 * (k % 8), x = -1 + 0.2 * (k / 8);
    const Point u{std::cos(down), -std::sin(down)};
    test::TestScene scene = test::scene_of({{x - 2.1 * u.x, 0.6 - 2.1 * u.z, 1, speed * u.x, speed * u.z}})
                                .between({test::segment("wall", {-far, 0}, {0, 0}),
                                          test::segment("wall", {0, 0}, {end.x, end.z})})
                                .with(Gravity{})
                                .lasting(20 * step, step);
    test::TestRun run(e > 0 ? scene.with(Restitution{e, e}) : scene);
    run.each_step([&](const StepReport& report) {
      const Bodies& b = run.bodies();
      for (const Segment& wall : {Segment{{-far, 0}, {0, 0}}, Segment{{0, 0}, end}})
        all.deepest = std::max(all.deepest, -touch(wall, b.x[0], b.z[0]).gap);
      all.largest_overlap = std::max(all.largest_overlap, report.overlap.max);
      all.unknown_sinkings += std::isnan(report.solve.residual.sinking);
    });
  }
  return all;
}

TEST(Joint, HoldsDiscsThatCrossItFast) {
  for (const double angle : {0.0, -0.1, -0.5, -1.2, -2.2, 0.3})
    for (const double e : {0.0, 0.1}) {
      const FastDiscs all = fast_discs_at(angle, e);
      EXPECT_LT(all.deepest, 1e-2) << angle << ", e = " << e;
      EXPECT_LT(all.largest_overlap, 1e-2) << angle << ", e = " << e;
      EXPECT_EQ(all.unknown_sinkings, 0) << angle << ", e = " << e;
    }
}

TEST(Joint, OfAnArcAndItsTangentIsNoCorner) {
  const auto halves =
      halves_of({0, 5}, 5, -std::numbers::pi / 2, -0.3);  // from the origin to the right and up
  std::array<Shape, 3> shapes{Segment{{-5, 0}, {0, 0}}, halves[0], halves[1]};
  const std::array<int, 3> together{0, 0, 0};
  join_ends(shapes, together);
  const double above = 0.5;
  EXPECT_TRUE(std::isinf(touch(shapes[1], -0.1, above).gap));
  EXPECT_TRUE(std::isinf(touch(shapes[0], 0.1, above + 0.001).gap));
  EXPECT_NEAR(touch(shapes[0], -0.1, above).gap, 0, 1e-15);
}

TEST(Joint, TurnsWithItsWallAndNeedsBothTogether) {
  auto [left, right] = joint(0);
  const Rigid turned(Pose{0.7, 1, 2});
  const Point centre = turned.moved({-0.1, 0.5});
  EXPECT_TRUE(std::isinf(touch(moved(turned, right), centre.x, centre.z).gap));
  std::array<Shape, 2> apart{Segment{{-5, 0}, {0, 0}}, Segment{{0, 0}, {5, 0}}};
  const std::array<int, 2> moving{0, 1};
  join_ends(apart, moving);
  EXPECT_NEAR(touch(apart[1], -0.1, 0.5).gap, std::hypot(0.1, 0.5) - 0.5, 1e-15);
}

}  // namespace
}  // namespace drumlin::particles
