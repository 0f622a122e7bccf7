#include "particles/scene/sequential_placement.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "particles/scene/placed_discs.hpp"
#include "particles/scene/random.hpp"

namespace drumlin::particles {
namespace {

constexpr double room_around = 1.01;  // radii are so much larger while discs are placed
// Equal discs stop at 0.547 (Hinrichsen, Feder, Jossang 1986) after endless attempts; at this share of it a
// few dozen do, and with unequal ones fewer.
constexpr double share_at_first = 0.42;
constexpr int attempts = 400;  // before the part of the region that is filled grows
constexpr double growth = 1.05;

/// Area of the part of a region below a height.
double area_below(const Region& region, double z) {
  if (const auto* box = std::get_if<RectangleRegion>(&region))
    return (box->max_mm[0] - box->min_mm[0]) *
           (std::clamp(z, box->min_mm[1], box->max_mm[1]) - box->min_mm[1]);
  const auto& circle = std::get<CircleRegion>(region);
  const double up = std::clamp((z - circle.center_mm[1]) / circle.radius_mm, -1.0, 1.0);
  return circle.radius_mm * circle.radius_mm *
         (std::asin(up) + up * std::sqrt(1 - up * up) + std::numbers::pi / 2);
}

/// Height below which the region has this area.
double height_of(const Region& region, double area) {
  auto [low, high] = extent_mm(region, 1);
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = (low + high) / 2;
    (area_below(region, middle) < area ? low : high) = middle;
  }
  return high;
}

}  // namespace

double area_mm2(const Region& region) { return area_below(region, extent_mm(region, 1).second); }

std::vector<Point_mm> sequential_centers_mm(std::span<const double> diameters_mm, const Region& region,
                                            const Obstacles& obstacles, std::uint64_t seed) {
  std::vector<std::size_t> order(diameters_mm.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return diameters_mm[a] > diameters_mm[b]; });
  double discs = 0;
  for (const double d : diameters_mm) discs += std::numbers::pi / 4 * d * d;
  RandomStream places(seed, "grains/position");
  std::vector<double> radii;
  for (const double d : diameters_mm) radii.push_back(room_around * d / 2);
  PlacedDiscs placed(radii);
  std::vector<Point_mm> centers(diameters_mm.size());
  const auto [left, right] = extent_mm(region, 0);
  const auto [bottom, top] = extent_mm(region, 1);
  double filled = std::min(discs / share_at_first, area_mm2(region)), height = height_of(region, filled);
  for (const std::size_t g : order) {
    const double radius = radii[g];
    for (int tries = 1;; ++tries) {
      const Point_mm center{places.uniform(left, right), places.uniform(bottom, height)};
      if (center[1] + radius <= height && inside(region, center, radius) && placed.free(center, radius) &&
          obstacles.clear(center, radius)) {
        placed.add(center, radius);
        centers[g] = center;
        break;
      }
      if (tries < attempts) continue;
      if (height >= top)
        throw InputError(
            {InputProblem{"", 0, 0, "grains.generated.count",
                          std::to_string(diameters_mm.size()) + " grains do not fit into the region",
                          "a larger region, or fewer grains"}});
      filled = std::min(filled * growth, area_mm2(region));
      height = filled >= area_mm2(region) ? top : height_of(region, filled);
      tries = 0;
    }
  }
  return centers;
}

}  // namespace drumlin::particles
