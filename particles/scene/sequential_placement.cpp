#include "particles/scene/sequential_placement.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <vector>

#include "coupling/common/errors.hpp"
#include "particles/scene/random.hpp"

namespace drumlin::particles {
namespace {

constexpr double room_around = 1.01;  // radii are so much larger while discs are placed
// Equal discs stop at 0.547 (Hinrichsen, Feder, Jossang 1986) after endless attempts; at this share of it a
// few dozen do, and with unequal ones fewer.
constexpr double share_at_first = 0.42;
constexpr int attempts = 400;  // before the part of the region that is filled grows
constexpr double growth = 1.05;

/// Discs by octave of size, each octave in cells of its largest diameter. Cells share the lists of a table: a
/// disc of another cell is looked at in vain, but does no harm.
class PlacedDiscs {
 public:
  /// With room for discs of these radii.
  explicit PlacedDiscs(std::span<const double> radii) {
    std::map<int, std::size_t> count;
    for (const double radius : radii) ++count[octave_of(radius)];
    for (const auto& [octave, discs] : count) octaves_[octave].assign(std::bit_ceil(2 * discs), -1);
    discs_.reserve(radii.size());
  }
  void add(const Point_mm& center, double radius) {
    const int octave = octave_of(radius);
    Lists& lists = octaves_.at(octave);
    std::int32_t& first = lists[list(lists, cell(center[0], octave), cell(center[1], octave))];
    discs_.push_back({center, radius, first});
    first = static_cast<std::int32_t>(discs_.size()) - 1;
  }
  bool free(const Point_mm& center, double radius) const {
    for (auto entry = octaves_.rbegin(); entry != octaves_.rend(); ++entry) {  // the largest fill most
      const auto& [octave, lists] = *entry;
      const double reach = radius + size(octave) / 2;
      const auto right = cell(center[0] + reach, octave), top = cell(center[1] + reach, octave);
      for (auto x = cell(center[0] - reach, octave); x <= right; ++x)
        for (auto z = cell(center[1] - reach, octave); z <= top; ++z)
          for (std::int32_t d = lists[list(lists, x, z)]; d >= 0; d = discs_[d].next)
            if (overlap(discs_[d], center, radius)) return false;
    }
    return true;
  }

 private:
  struct Disc {
    Point_mm center;
    double radius;
    std::int32_t next;  // of the same list; -1: the last
  };
  using Lists = std::vector<std::int32_t>;  // the disc that each begins with; -1: none
  static int octave_of(double radius) { return std::ilogb(2 * radius); }
  static double size(int octave) { return std::ldexp(1.0, octave + 1); }
  static std::int64_t cell(double x, int octave) {
    const double place = x / size(octave);
    const auto towards_0 = static_cast<std::int64_t>(place);
    return towards_0 - (place < static_cast<double>(towards_0));
  }
  static std::size_t list(const Lists& lists, std::int64_t x, std::int64_t z) {
    const auto mixed = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u ^
                       static_cast<std::uint64_t>(z) * 0xc2b2ae3d27d4eb4fu;
    return static_cast<std::size_t>(mixed ^ mixed >> 32) & (lists.size() - 1);
  }
  static bool overlap(const Disc& disc, const Point_mm& center, double radius) {
    const double dx = disc.center[0] - center[0], dz = disc.center[1] - center[1], sum = disc.radius + radius;
    return dx * dx + dz * dz < 1.000001 * sum * sum && std::hypot(dx, dz) < sum;
  }

  std::vector<Disc> discs_;
  std::map<int, Lists> octaves_;
};

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

bool inside(const Region& region, const Point_mm& center, double radius) {
  if (const auto* circle = std::get_if<CircleRegion>(&region))
    return std::hypot(center[0] - circle->center_mm[0], center[1] - circle->center_mm[1]) + radius <=
           circle->radius_mm;
  const auto& box = std::get<RectangleRegion>(region);
  return center[0] - radius >= box.min_mm[0] && center[0] + radius <= box.max_mm[0] &&
         center[1] - radius >= box.min_mm[1] && center[1] + radius <= box.max_mm[1];
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
                                            std::uint64_t seed) {
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
      if (center[1] + radius <= height && inside(region, center, radius) && placed.free(center, radius)) {
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
