// The shape of a free surface and the material below it, without any flow.
#include "continuum/model/surface_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace drumlin {
using namespace continuum;
namespace {

constexpr double radius = 15, axis_offset = 1;

SurfaceShape hump() {
  return {ChordDomain{.radius = radius, .axis_offset = axis_offset}, {0.1, -0.3, -0.8, 0.2, 0.1, 0, 0.05}};
}

double from_axis(Vec2 p) { return std::hypot(p.x, p.z - axis_offset); }

TEST(SurfaceShape, EndsSlideAlongTheWall) {
  EXPECT_NEAR(from_axis(surface_point(hump(), -1)), radius, 1e-12);
  EXPECT_NEAR(from_axis(surface_point(hump(), 1)), radius, 1e-12);
  EXPECT_LT(surface_point(hump(), -1).z, -0.2);  // they did move
}

TEST(SurfaceShape, RiseHasItsDerivativeAndItsNormal) {
  const SurfaceShape shape = hump();
  for (const double s : {-1.0, -0.6, 0.0, 0.3, 1.0}) {
    double sum = 0;
    for (std::size_t n = 0; n < shape.coefficient.size(); ++n) sum += shape.coefficient[n] * chebyshev(n, s);
    EXPECT_NEAR(rise(shape, s), sum, 1e-14);
  }
  constexpr double h = 1e-6;
  for (const double s : {-0.9, -0.2, 0.4, 0.95}) {
    EXPECT_NEAR(rise_slope(shape, s), (rise(shape, s + h) - rise(shape, s - h)) / (2 * h), 1e-7);
    const Vec2 a = surface_point(shape, s - h), b = surface_point(shape, s + h), n = surface_normal(shape, s);
    EXPECT_NEAR(n.x * (b.x - a.x) + n.z * (b.z - a.z), 0, 1e-12);
    EXPECT_NEAR(std::hypot(n.x, n.z), 1, 1e-14);
    EXPECT_GT(n.z, 0);
    const Vec2 p = surface_point(shape, s);
    EXPECT_NEAR(across(shape, p), s, 1e-13);
    EXPECT_NEAR(height(shape, p.x), p.z, 1e-10);
  }
}

TEST(SurfaceShape, RestrainedItKeepsTheFillAndTheSlopeOfTheMiddle) {
  SurfaceShape shape = hump();
  restrain(shape, 6);
  EXPECT_NEAR(mean_slope(shape, 6), 0, 1e-13);
  // The area below it, as a sum of trapezia down to a level under all of it, against that under the chord.
  const auto area = [](const SurfaceShape& of) {
    double sum = 0;
    constexpr int pieces = 20000;
    for (int i = 0; i < pieces; ++i) {
      const Vec2 a = surface_point(of, -1 + 2.0 * i / pieces),
                 b = surface_point(of, -1 + 2.0 * (i + 1) / pieces);
      // Sector about the axis.
      sum += 0.5 * (a.x * (b.z - axis_offset) - b.x * (a.z - axis_offset));
    }
    const Vec2 left = surface_point(of, -1), right = surface_point(of, 1);
    const double arc = std::atan2(right.x, axis_offset - right.z) - std::atan2(left.x, axis_offset - left.z);
    return 0.5 * radius * radius * arc - sum;
  };
  const SurfaceShape flat{shape.domain, std::vector<double>(7, 0.0)};
  EXPECT_NEAR(area(shape) / area(flat), 1, 1e-7);
  EXPECT_NEAR(area_above(shape), 0, 1e-9);
  EXPECT_EQ(shape.coefficient[2], hump().coefficient[2]);
}

TEST(SurfaceShape, DisplacesNothingOutOfTheDrumAndNothingDeepDown) {
  const SurfaceShape shape = hump();
  const double half_chord = std::sqrt(radius * radius - axis_offset * axis_offset);
  for (const double s : {-1.0, -0.5, 0.1, 1.0}) {
    const Vec2 to = displaced(shape, {s * half_chord, 0}), on = surface_point(shape, s);
    EXPECT_NEAR(to.x, on.x, 1e-12);
    EXPECT_NEAR(to.z, on.z, 1e-12);
  }
  for (const double angle : {-1.2, -0.8, 0.9, 1.3}) {
    const Vec2 wall{radius * std::sin(angle), axis_offset - radius * std::cos(angle)};
    EXPECT_NEAR(from_axis(displaced(shape, wall)), radius, 1e-12);
  }
  const Vec2 deep = displaced(shape, {2, -12.5});
  EXPECT_EQ(deep.x, 2);
  EXPECT_EQ(deep.z, -12.5);
}

TEST(SurfaceShape, OfABoxRisesStraightUp) {
  const SurfaceShape shape{BoxDomain{.width = 20, .height = 8}, {0, 0.5}};
  const Vec2 top = displaced(shape, {5, 0});
  EXPECT_EQ(top.x, 5);
  EXPECT_NEAR(top.z, 0.25, 1e-15);
  EXPECT_NEAR(area_above(shape), 0, 1e-12);
}

}  // namespace
}  // namespace drumlin
