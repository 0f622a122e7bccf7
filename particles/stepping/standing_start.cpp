#include "particles/stepping/standing_start.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>
#include <vector>

#include "particles/bodies/vectors.hpp"
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
      const double beside = across(down_, position(bodies, b));
      least = std::min(least, beside), most = std::max(most, beside);
    }
    first_ = least;
    width_ = std::max(column_width, (most - least) / static_cast<double>(grains));
    columns_.resize(static_cast<std::size_t>((most - least) / width_) + 1);
    for (std::size_t b = 0; b < grains; ++b)
      columns_[column(position(bodies, b))].push_back(
          {dot(position(bodies, b), down_), 1 / bodies.inverse_mass[b]});
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
  double above(const Point& at) const {
    const auto& in_column = columns_[column(at)];
    const auto next = std::lower_bound(in_column.begin(), in_column.end(), std::pair(dot(at, down_), 0.0));
    return next == in_column.begin() ? 0 : std::prev(next)->second / width_;
  }

 private:
  std::size_t column(const Point& at) const {
    return std::min(columns_.size() - 1,
                    static_cast<std::size_t>(std::max(0.0, (across(down_, at) - first_) / width_)));
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
    const Point at = position(bodies, pair.i) - bodies.radius[pair.i] * Point{pair.n_x, pair.n_z};
    impulses[static_cast<std::size_t>(unknowns) * a] =
        time_step * g * overburden.above(at) * per_pressure / reach;
  }
  ImpulseCache memory{{}, {}, std::move(impulses), time_step};
  for (const Candidate& pair : pairs) memory.i.push_back(pair.i), memory.j.push_back(pair.j);
  return memory;
}

}  // namespace drumlin::particles
