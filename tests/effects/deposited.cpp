// Grains that are deposited one by one: a packing nearly at rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/core/basics/errors.hpp"
#include "particles/scene/deposited_placement.hpp"
#include "particles/scene/random.hpp"
#include "particles/scene/sizes.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
using namespace particles;
namespace {

const Region rectangle = RectangleRegion{{0, 0}, {300, 300}}, circle = CircleRegion{{20, -30}, 200};

std::vector<double> uniform_diameters(int count, double smallest, double largest) {
  RandomStream random(3, "sizes");
  return diameters_mm({count, smallest, largest, rectangle}, random);
}

/// Distance of a disc's rim from the region's border, from inside.
double to_border(const Region& region, const Point_mm& center, double radius) {
  if (const auto* c = std::get_if<CircleRegion>(&region))
    return c->radius_mm - radius - std::hypot(center[0] - c->center_mm[0], center[1] - c->center_mm[1]);
  const auto& box = std::get<RectangleRegion>(region);
  return std::min({center[0] - radius - box.min_mm[0], box.max_mm[0] - radius - center[0],
                   center[1] - radius - box.min_mm[1]});
}

/// Whether what a disc touches holds it: a floor, or something below it on its left and on its right.
bool is_held(const Region& region, const std::vector<Point_mm>& centers, const std::vector<double>& diameters,
             std::size_t disc) {
  const auto [x, z] = centers[disc];
  const double radius = diameters[disc] / 2, near = 1e-5 * radius;
  bool left = false, right = false;
  for (std::size_t other = 0; other < disc; ++other) {  // those that lay there before
    const double dx = centers[other][0] - x, reach = radius + diameters[other] / 2;
    if (std::hypot(dx, centers[other][1] - z) > reach + near) continue;
    left |= dx <= near, right |= dx >= -near;
  }
  if (to_border(region, {x, z}, radius) < near) {
    if (const auto* c = std::get_if<CircleRegion>(&region)) {
      left |= x <= c->center_mm[0] + near, right |= x >= c->center_mm[0] - near;
    } else {
      const auto& box = std::get<RectangleRegion>(region);
      if (z - radius - box.min_mm[1] < near) return true;
      left |= x - radius - box.min_mm[0] < near, right |= box.max_mm[0] - radius - x < near;
    }
  }
  return left && right;
}

TEST(Deposited, EveryDiscLiesInAHollowAndOverlapsNothing) {
  for (const Region& region : {rectangle, circle})
    for (const double smallest : {3.0, 1.0, 0.3}) {
      const auto diameters = uniform_diameters(2000, smallest, 3.6);
      const auto centers = deposited_centers_mm(diameters, region, 1);
      ASSERT_EQ(centers.size(), diameters.size());
      for (std::size_t a = 0; a < centers.size(); ++a) {
        ASSERT_GE(to_border(region, centers[a], diameters[a] / 2), 0) << a;
        ASSERT_TRUE(is_held(region, centers, diameters, a)) << a << " of " << smallest;
        for (std::size_t b = 0; b < a; ++b)
          ASSERT_GE(std::hypot(centers[a][0] - centers[b][0], centers[a][1] - centers[b][1]),
                    (diameters[a] + diameters[b]) / 2);
      }
      EXPECT_EQ(centers, deposited_centers_mm(diameters, region, 1));
      EXPECT_NE(centers, deposited_centers_mm(diameters, region, 2));
    }
}

TEST(Deposited, ThePackingIsDenseAndItsSurfaceLevel) {
  // Visscher and Bolsterli's discs fill 0.82; those of unequal sizes and those that fall where the surface is
  // lowest a little less or more.
  for (const Region& region : {rectangle, circle}) {
    const auto diameters = uniform_diameters(6000, 3.0, 3.6);
    const auto centers = deposited_centers_mm(diameters, region, 1);
    const double middle = (extent_mm(region, 0).first + extent_mm(region, 0).second) / 2, half = 75;
    double highest_low = 1e9, highest = -1e9;
    for (double x = middle - half; x < middle + half; x += 15) {  // the highest disc of each of ten columns
      double top = -1e9;
      for (const auto& center : centers)
        if (std::abs(center[0] - x - 7.5) < 7.5) top = std::max(top, center[1]);
      highest_low = std::min(highest_low, top), highest = std::max(highest, top);
    }
    EXPECT_LT(highest - highest_low, 3 * 3.3);
    // Between two heights, away from the surface and the border.
    const double top = highest_low - 10, bottom = top - 100;
    double area = 0;
    for (std::size_t disc = 0; disc < centers.size(); ++disc)
      if (std::abs(centers[disc][0] - middle) < half && centers[disc][1] > bottom && centers[disc][1] < top)
        area += std::numbers::pi / 4 * diameters[disc] * diameters[disc];
    const double filled = area / (2 * half * (top - bottom));
    EXPECT_GT(filled, 0.80);
    EXPECT_LT(filled, 0.86);
  }
}

TEST(Deposited, AFullRegionSaysHowManyFound) {
  const auto diameters = uniform_diameters(2000, 3.0, 3.6);
  for (const Region& region :
       {Region{RectangleRegion{{0, 0}, {100, 100}}}, Region{CircleRegion{{0, 0}, 60}}}) {
    try {
      deposited_centers_mm(diameters, region, 1);
      ADD_FAILURE() << "2000 discs of 17,000 mm2 found a place";
    } catch (const InputError& error) {
      expect_has(error.what(), "found a place");
    }
  }
  // All but full: what fits is put there.
  const std::vector<double> few(900, 3.3);
  EXPECT_EQ(deposited_centers_mm(few, CircleRegion{{0, 0}, 60}, 1).size(), few.size());
  const std::vector<double> one(1, 100.0);
  const auto alone = deposited_centers_mm(one, CircleRegion{{0, 0}, 60}, 1);
  EXPECT_NEAR(alone[0][0], 0, 1e-3);
  EXPECT_NEAR(alone[0][1], -10, 1e-3);
}

}  // namespace
}  // namespace drumlin
