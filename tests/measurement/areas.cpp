#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "particles/measurement/frame/disc_area.hpp"

namespace drumlin {
using namespace particles;
namespace {

/// Midpoint rule over the chord lengths; its error falls like n^-1.5 at the rim: 1e-6 with 20,000 strips.
double area_by_strips(double x, double z, double radius, const Rectangle& rectangle) {
  constexpr int strips = 20000;
  const double from = std::max(rectangle.x_min, x - radius), to = std::min(rectangle.x_max, x + radius);
  double area = 0;
  for (int i = 0; i < strips && from < to; ++i) {
    const double at = from + (i + 0.5) * (to - from) / strips;
    const double half = std::sqrt(std::max(0.0, radius * radius - (at - x) * (at - x)));
    area += std::max(0.0, std::min(rectangle.z_max, z + half) - std::max(rectangle.z_min, z - half)) *
            (to - from) / strips;
  }
  return area;
}

TEST(DiscArea, DiscOutsideCountsNothing) {
  EXPECT_EQ(disc_area_in(0, 0, 1, {1, 2, -1, 1}), 0);
  EXPECT_NEAR(disc_area_in(0, 0, 1, {0.8, 2, 0.8, 2}), 0, 1e-14);  // the corner passes by
}

TEST(DiscArea, LargeDiscAroundASmallRectangleFillsIt) {
  EXPECT_NEAR(disc_area_in(0, 0, 68, {-10, 10, -30, -29}), 20, 1e-10);  // cancellation: 68^2 times 1e-16
}

TEST(DiscArea, InfiniteStripIsALayerOfTheDisc) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(disc_area_in(5, 0.5, 0.5, {-infinity, infinity, 0, 0.5}), std::numbers::pi / 8, 1e-14);
}

TEST(DiscArea, AgreesWithStripsForEveryWayOfCutting) {
  for (double x : {-0.9, -0.4, 0.0, 0.3, 0.7, 1.2})
    for (double z : {-0.8, -0.2, 0.1, 0.6, 1.3})
      for (double radius : {0.3, 0.7, 1.5}) {
        const Rectangle rectangle{-0.5, 0.6, -0.4, 0.5};
        EXPECT_NEAR(disc_area_in(x, z, radius, rectangle), area_by_strips(x, z, radius, rectangle), 1e-5)
            << x << ' ' << z << ' ' << radius;
      }
}

TEST(DiscArea, TilesSumToTheDisc) {
  double sum = 0;
  for (int i = -3; i < 3; ++i)
    for (int j = -3; j < 3; ++j) sum += disc_area_in(0.37, -0.21, 1.9, {i * 1.0, i + 1.0, j * 1.0, j + 1.0});
  EXPECT_NEAR(sum, std::numbers::pi * 1.9 * 1.9, 1e-12);
}

}  // namespace
}  // namespace drumlin
