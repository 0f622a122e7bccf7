#include "particles/scene/deposited_placement.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "coupling/core/basics/errors.hpp"
#include "particles/scene/placed_discs.hpp"
#include "particles/scene/random.hpp"

namespace drumlin::particles {
namespace {

constexpr double widened = 1 + 4e-7;      // radii are so much larger while discs are placed
constexpr double nearly_touching = 1e-9;  // relative to a radius
constexpr double bin_width = 8;           // in mean diameters: grains fall where a bin's surface is lowest
constexpr int attempts_in_bin = 5;        // to find a place in a bin that is then called full

using Disc = PlacedDiscs::Disc;

/// What a disc lies or rolls on.
struct Support {
  enum Kind { hollow, floor, arc, disc } kind;
  Disc on{};  ///< where it is a disc
};

/// The region's border and the discs that lie in it, as one of them sees them that falls and rolls. Places
/// are found with square roots alone: they are the same with every mathematical library.
class Landscape {
 public:
  Landscape(const Region& region, std::span<const double> radii)
      : region_(region),
        circle_(std::get_if<CircleRegion>(&region)),
        placed_(radii),
        largest_(*std::max_element(radii.begin(), radii.end())) {}
  void add(const Point_mm& center, double radius) { placed_.add(center, radius); }

  /// Height of the centre of a disc that lies on the border below x.
  double floor_mm(double x, double radius) const {
    if (!circle_) return extent_mm(region_, 1).first + radius;
    const double reach = circle_->radius_mm - radius, dx = x - circle_->center_mm[0];
    return circle_->center_mm[1] - std::sqrt(std::max(0.0, reach * reach - dx * dx));
  }

  /// Where a disc comes to rest that falls from `start`; nothing if that is not free or outside.
  std::optional<Point_mm> rest(const Point_mm& start, double radius) const {
    Point_mm at = start;
    for (Support support = fall(at, radius, nullptr);;) {
      if (!inside(region_, at, radius * (1 - nearly_touching))) return std::nullopt;
      if (support.kind == Support::hollow || support.kind == Support::floor) break;
      support = support.kind == Support::arc ? roll_down_arc(at, radius) : roll(at, radius, support.on);
    }
    if (!placed_.free(at, radius * (1 - 1e-7))) return std::nullopt;
    return at;
  }

 private:
  /// Lets a disc at `at` fall, past the disc that it has left.
  Support fall(Point_mm& at, double radius, const Disc* left) const {
    const double floor = floor_mm(at[0], radius), height = 2 * largest_;
    for (double top = at[1]; top > floor; top -= height) {
      std::optional<std::pair<double, Disc>> highest;
      placed_.any_near({at[0] - radius, top - height - radius}, {at[0] + radius, top}, [&](const Disc& disc) {
        const double reach = disc.radius + radius, dx = at[0] - disc.center[0];
        if (std::abs(dx) >= reach || (left && disc.center == left->center)) return false;
        const double z = disc.center[1] + std::sqrt(reach * reach - dx * dx);
        if (z <= at[1] + nearly_touching * radius && (!highest || z > highest->first))
          highest.emplace(z, disc);
        return false;
      });
      if (!highest || highest->first < std::max(floor, top - height)) continue;
      at[1] = highest->first;
      return {Support::disc, highest->second};
    }
    at[1] = floor;
    return {circle_ ? Support::arc : Support::floor};
  }

  /// Point where circles of radii a and b around two centres cross: the one that turns to the left, seen from
  /// the first centre towards the second (`side` = 1), or to the right (-1).
  static std::optional<Point_mm> crossing(const Point_mm& first, double a, const Point_mm& second, double b,
                                          double side) {
    const double dx = second[0] - first[0], dz = second[1] - first[1], distance2 = dx * dx + dz * dz;
    if (distance2 == 0) return std::nullopt;
    const double along = (a * a - b * b + distance2) / (2 * distance2);
    const double across2 = a * a / distance2 - along * along;
    if (across2 < 0) return std::nullopt;
    const double across = side * std::sqrt(across2);
    return Point_mm{first[0] + along * dx - across * dz, first[1] + along * dz + across * dx};
  }

  /// Rolls downhill over a disc to what comes first: another disc, the border, or the fall from its side.
  Support roll(Point_mm& at, double radius, const Disc on) const {
    const double way = at[0] < on.center[0] ? -1 : 1, reach = on.radius + radius;
    Point_mm next{on.center[0] + way * reach, on.center[1]};
    Support support{Support::disc};
    bool falls = true;
    const auto stops = [&](const Point_mm& place, const Support& what) {
      if (place[1] > at[1] + nearly_touching * radius || place[1] < next[1] ||
          way * (place[0] - on.center[0]) < -nearly_touching * radius)
        return;
      next = place, support = what, falls = false;
    };
    const double far = reach + radius;
    placed_.any_near(
        {on.center[0] - far, on.center[1] - far}, {on.center[0] + far, on.center[1] + far},
        [&](const Disc& disc) {
          if (disc.center == on.center) return false;
          if (const auto place = crossing(on.center, reach, disc.center, disc.radius + radius, way))
            stops(*place,
                  {way * (disc.center[0] - (*place)[0]) >= 0 ? Support::hollow : Support::disc, disc});
          return false;
        });
    if (circle_) {
      const auto place = crossing(on.center, reach, circle_->center_mm, circle_->radius_mm - radius, -way);
      if (place)
        stops(*place, {way * ((*place)[0] - circle_->center_mm[0]) >= 0 ? Support::hollow : Support::arc});
    } else {
      const auto [left, right] = extent_mm(region_, 0);
      const double side = way > 0 ? right - radius : left + radius, dx = side - on.center[0];
      if (std::abs(dx) < reach)
        stops({side, on.center[1] + std::sqrt(reach * reach - dx * dx)}, {Support::hollow});
      const double floor = floor_mm(side, radius), dz = floor - on.center[1];
      if (std::abs(dz) < reach)
        stops({on.center[0] + way * std::sqrt(reach * reach - dz * dz), floor}, {Support::floor});
    }
    at = next;
    return falls ? fall(at, radius, &on) : support;
  }

  /// Rolls down the circle's border, piece by piece, to the first disc or to its lowest point.
  Support roll_down_arc(Point_mm& at, double radius) const {
    const Point_mm& center = circle_->center_mm;
    const double reach = circle_->radius_mm - radius, way = at[0] < center[0] ? 1 : -1;
    const double step = 4 * largest_;
    const auto lowest = [&](const Point_mm& place) { return way * (place[0] - center[0]) >= 0; };
    while (!lowest(at)) {
      const double dx = (at[0] - center[0]) / reach, dz = (at[1] - center[1]) / reach;
      Point_mm end{dx - way * dz * step / reach, dz + way * dx * step / reach};  // along the tangent
      const double length = std::sqrt(end[0] * end[0] + end[1] * end[1]);
      end = {center[0] + reach * end[0] / length, center[1] + reach * end[1] / length};
      if (lowest(end)) end = {center[0], center[1] - reach};
      std::optional<Point_mm> first;
      placed_.any_near({std::min(at[0], end[0]) - radius, end[1] - radius},
                       {std::max(at[0], end[0]) + radius, at[1] + radius}, [&](const Disc& disc) {
                         const auto place = crossing(center, reach, disc.center, disc.radius + radius, -way);
                         if (place && way * (disc.center[0] - at[0]) > 0 &&
                             (*place)[1] <= at[1] + nearly_touching * radius && (*place)[1] >= end[1] &&
                             !lowest(*place) && (!first || (*place)[1] > (*first)[1]))
                           first = place;
                         return false;
                       });
      at = first.value_or(end);
      if (first) break;
    }
    return {Support::hollow};
  }

  const Region& region_;
  const CircleRegion* circle_;  // the region, if it is one
  PlacedDiscs placed_;
  double largest_;
};

/// The height of the surface along x, in bins, and which bin is lowest.
class Surface {
 public:
  /// `discs`: their number; there are no more bins.
  Surface(const Region& region, double mean_diameter, std::size_t discs, const Landscape& landscape) {
    const auto [left, right] = extent_mm(region, 0);
    left_ = left, width_ = right - left;
    const double bins = std::clamp(width_ / (bin_width * mean_diameter), 1.0, static_cast<double>(discs));
    tops_.resize(static_cast<std::size_t>(bins));
    for (std::size_t bin = 0; bin < tops_.size(); ++bin)
      set_top(bin, landscape.floor_mm((left_of(bin) + left_of(bin + 1)) / 2, 0));
  }
  double left_of(std::size_t bin) const {
    return left_ + width_ * static_cast<double>(bin) / static_cast<double>(tops_.size());
  }
  /// Highest top of the bins between two places.
  double top(double from, double to) const {
    return *std::max_element(tops_.begin() + bin_of(from), tops_.begin() + bin_of(to) + 1);
  }
  /// Tells that something reaches up to a height.
  void raise(double from, double to, double top) {
    for (auto bin = bin_of(from); bin <= bin_of(to); ++bin)
      if (top > tops_[bin]) set_top(static_cast<std::size_t>(bin), top);
  }
  /// The lowest bin that is not closed, if there is one.
  std::optional<std::size_t> lowest() {
    while (!lowest_.empty() && -lowest_.top().first != tops_[lowest_.top().second])
      lowest_.pop();  // it has risen since
    return lowest_.empty() ? std::nullopt : std::optional(lowest_.top().second);
  }
  /// The lowest bin is full, until something raises it.
  void close_lowest() { lowest_.pop(); }

 private:
  void set_top(std::size_t bin, double top) {
    tops_[bin] = top;
    lowest_.push({-top, bin});
  }
  std::ptrdiff_t bin_of(double x) const {
    const auto bins = static_cast<double>(tops_.size());
    return static_cast<std::ptrdiff_t>(std::clamp((x - left_) / width_ * bins, 0.0, bins - 1));
  }
  double left_ = 0, width_ = 0;
  std::vector<double> tops_;
  std::priority_queue<std::pair<double, std::size_t>> lowest_;
};

}  // namespace

std::vector<Point_mm> deposited_centers_mm(std::span<const double> diameters_mm, const Region& region,
                                           std::uint64_t seed) {
  std::vector<double> radii;
  double mean = 0;
  for (const double d : diameters_mm) {
    radii.push_back(widened * d / 2);
    mean += d / static_cast<double>(diameters_mm.size());
  }
  Landscape landscape(region, radii);
  Surface surface(region, mean, radii.size(), landscape);
  RandomStream places(seed, "grains/position");
  std::vector<Point_mm> centers;
  centers.reserve(radii.size());
  int failed = 0;
  while (centers.size() < radii.size()) {
    const double radius = radii[centers.size()];
    const auto bin = surface.lowest();
    if (!bin)
      throw InputError({InputProblem{
          "", 0, 0, "grains.generated.count",
          std::to_string(diameters_mm.size()) +
              " grains do not fit into the region: " + std::to_string(centers.size()) + " found a place",
          "a larger region, or fewer grains"}});
    const double from = std::max(surface.left_of(*bin), extent_mm(region, 0).first + radius),
                 to = std::min(surface.left_of(*bin + 1), extent_mm(region, 0).second - radius);
    const double x = places.uniform(from, std::max(from, to));
    const double start = std::max(surface.top(x - radius, x + radius), landscape.floor_mm(x, radius));
    if (const auto center = landscape.rest({x, start + radius}, radius)) {
      surface.raise((*center)[0] - radius, (*center)[0] + radius, (*center)[1] + radius);
      landscape.add(*center, radius);
      centers.push_back(*center);
      failed = 0;
    } else if (++failed == attempts_in_bin) {
      surface.close_lowest();
      failed = 0;
    }
  }
  return centers;
}

}  // namespace drumlin::particles
