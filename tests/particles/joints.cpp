// Ends of thin walls at which another wall goes on.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "particles/bodies/arc.hpp"
#include "particles/detection/contact_list.hpp"

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
