#include "particles/stepping/standing_start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include "particles/detection/contact_list.hpp"

namespace drumlin::particles {
namespace {

constexpr double touching_gap = 1e-5;  // gap, in mean diameters
constexpr double column_width = 6;     // in mean diameters; more where grains are scattered
constexpr double packing = 0.82;       // of deposited discs, about

/// Weight of the grains above each depth, per width, in columns along gravity.
class Overburden {
 public:
  Overburden(const Bodies& bodies, const Point& gravity)
      : down_{gravity.x / std::hypot(gravity.x, gravity.z), gravity.z / std::hypot(gravity.x, gravity.z)} {
    const std::size_t grains = bodies.count();
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (std::size_t b = 0; b < grains; ++b) {
      const double across = across_of(bodies.x[b], bodies.z[b]);
      least = std::min(least, across), most = std::max(most, across);
    }
    first_ = least;
    width_ = std::max(column_width, (most - least) / static_cast<double>(grains));
    columns_.resize(static_cast<std::size_t>((most - least) / width_) + 1);
    for (std::size_t b = 0; b < grains; ++b)
      columns_[column(across_of(bodies.x[b], bodies.z[b]))].push_back(
          {depth_of(bodies.x[b], bodies.z[b]), 1 / bodies.inverse_mass[b]});
    for (auto& column : columns_) {
      std::sort(column.begin(), column.end());
      double above = 0;
      for (auto& [depth, mass] : column) {
        const double own = mass;
        mass = above + own / 2;
        above += own;
      }
    }
  }
  /// Mass per width above a position.
  double above(double x, double z) const {
    const auto& in_column = columns_[column(across_of(x, z))];
    const auto next = std::lower_bound(in_column.begin(), in_column.end(), std::pair(depth_of(x, z), 0.0));
    return next == in_column.begin() ? 0 : std::prev(next)->second / width_;
  }

 private:
  double depth_of(double x, double z) const { return x * down_.x + z * down_.z; }
  double across_of(double x, double z) const { return x * down_.z - z * down_.x; }
  std::size_t column(double across) const {
    return std::min(columns_.size() - 1, static_cast<std::size_t>(std::max(0.0, (across - first_) / width_)));
  }
  Point down_;
  double first_ = 0, width_ = column_width;
  std::vector<std::vector<std::pair<double, double>>> columns_;
};

}  // namespace

bool starts_deposited(const Scene& scene) {
  const auto deposited = [](const auto& source) {
    const auto* made = std::get_if<GeneratedGrains>(&source);
    return made && made->deposited();
  };
  return deposited(scene.grains.source) ||
         std::any_of(scene.grains.groups.begin(), scene.grains.groups.end(),
                     [&](const GrainGroup& group) { return deposited(group.source); });
}

ImpulseCache impulses_under_weight(const Bodies& bodies, std::span<const Shape> shapes, const Period& period,
                                   const Point& gravity, double time_step, int unknowns) {
  const std::size_t grains = bodies.count();
  const std::vector<double> rest(grains, 0.0);
  const std::vector<ShapeStep> still(shapes.size());
  ContactDetection detection;
  const auto& pairs = detection.find(bodies, rest, rest, {shapes, still, 1, touching_gap, period});
  // Mean stress sum r_n l / (2 A) of contacts of length l, in an area A: r_n = 2 p A / (contacts l).
  double area = 0;
  for (const double radius : bodies.radius) area += std::numbers::pi * radius * radius / packing;
  const double g = std::hypot(gravity.x, gravity.z);
  const double per_pressure = 2 * area / static_cast<double>(std::max<std::size_t>(1, pairs.size()));
  const Overburden overburden(bodies, gravity);
  std::vector<double> impulses(static_cast<std::size_t>(unknowns) * pairs.size(), 0.0);
  for (std::size_t a = 0; a < pairs.size(); ++a) {
    const Candidate& pair = pairs[a];
    const double reach =
        bodies.radius[pair.i] + (pair.j >= 0 ? bodies.radius[pair.j] : bodies.radius[pair.i]);
    const double x = bodies.x[pair.i] - pair.n_x * bodies.radius[pair.i],
                 z = bodies.z[pair.i] - pair.n_z * bodies.radius[pair.i];
    impulses[static_cast<std::size_t>(unknowns) * a] =
        time_step * g * overburden.above(x, z) * per_pressure / reach;
  }
  ImpulseCache memory{{}, {}, std::move(impulses), time_step};
  for (const Candidate& pair : pairs) memory.i.push_back(pair.i), memory.j.push_back(pair.j);
  return memory;
}

}  // namespace drumlin::particles
