#include "particles/measurement/grains/voronoi_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "coupling/core/basics/no_value.hpp"
#include "particles/bodies/cell_path.hpp"
#include "particles/measurement/frame/images.hpp"

namespace drumlin::particles {
namespace {

constexpr double mean_weight = 0.25;  // square of the radius of a grain of diameter 1

double square(double value) { return value * value; }

/// The period of a snapshot; of one that is open in z it may begin anywhere.
Period domain_of(const Snapshot& snapshot) {
  Period period = period_of(snapshot);
  if (period.open()) period.length = snapshot.period_x;
  return period;
}

}  // namespace

VoronoiTessellation::VoronoiTessellation(const Snapshot& snapshot, double reach)
    // What is inside a circle knows no period.
    : period_(snapshot.container_radius > 0 ? Period{} : domain_of(snapshot)),
      container_radius_(snapshot.container_radius),
      tangent_squared_(reach * reach - mean_weight) {
  // No place of a cell that is periodic in both directions is half as far from an image of a grain.
  if (!period_.open_z())
    tangent_squared_ = period_.length * period_.length + period_.length_z * period_.length_z;
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const double r = snapshot.radius[i];
    Point at{snapshot.x[i], snapshot.z[i]};
    if (container_radius_ > 0) at.x -= snapshot.container_x, at.z -= snapshot.container_z;
    const auto [x, z] = period_.first(at);
    const bool inside = !(container_radius_ > 0) || x * x + z * z <= container_radius_ * container_radius_;
    const bool takes_part = inside && std::isfinite(x + z) && std::isfinite(r) && r > 0;
    grains_.push_back(takes_part ? static_cast<std::int32_t>(sites_.count()) : -1);
    if (takes_part) add_body(sites_, x, z, r);
  }
  if (sites_.count() == 0) return;
  grids_.sort({sites_, sites_.v_x, sites_.v_z, Period{}}, 0);  // images are looked for one by one
  for (const CellGrid& grid : grids_.grids()) {
    double& largest = largest_.emplace_back(0);
    for (const NearGrain& site : grid.grains()) largest = std::max(largest, site.radius);
  }
}

bool VoronoiTessellation::gather(std::size_t own, const CellGrid& grid, double reach, double most_squared) {
  neighbours_.clear();
  const double own_weight = square(sites_.radius[own]);
  bool has_room = true;
  const auto add = [&](std::size_t site, double x, double z) {
    const double distance_squared = x * x + z * z, its_weight = square(sites_.radius[site]);
    if (distance_squared == 0) {
      if (its_weight > own_weight || (its_weight == own_weight && site < own)) has_room = false;
      return;
    }
    const double offset = (distance_squared + own_weight - its_weight) / 2;
    if (offset > 0 && offset * offset >= distance_squared * most_squared) return;  // passes by
    neighbours_.push_back({x, z, distance_squared, offset});
  };
  // Beyond the ends of a period stand its images, the grain's own among them: seen from an image of it.
  const Rectangle around{period_.origin - reach, period_.origin + period_.length + reach,
                         period_.origin_z - reach, period_.origin_z + period_.length_z + reach};
  each_image(period_, {sites_.x[own], sites_.z[own]}, around, [&](const Vector<2>& at) {
    grid.near(at[0] - reach, at[0] + reach, at[1] - reach, at[1] + reach, [&](const NearGrain& other) {
      add(static_cast<std::size_t>(other.body), other.x - at[0], other.z - at[1]);
    });
  });
  return has_room;
}

void VoronoiTessellation::cut_by_grid(std::size_t site, std::size_t grid) {
  const double largest = largest_[grid];
  const double own_weight = square(sites_.radius[site]), end_squared = own_weight + tangent_squared_;
  double searched = 0;
  while (!polygon_.empty()) {
    const double most_squared = std::min(polygon_.largest_distance_squared(), end_squared);
    // Lines that come nearer than `most` belong to centres no farther than this.
    const double needed =
        std::sqrt(most_squared) + std::sqrt(std::max(0.0, most_squared + square(largest) - own_weight));
    if (searched >= needed) return;
    // In a dense packing corners lie within 0.7 diameters, so that neighbours within 1.5 settle nearly every
    // cell.
    searched = searched == 0 ? std::min(needed, 3 * largest) : needed;
    if (!gather(site, grids_.grids()[grid], searched, most_squared)) {
      polygon_.clear();
      return;
    }
    // Near ones first: they leave little for the others to cut.
    std::sort(neighbours_.begin(), neighbours_.end(),
              [](const Neighbour& a, const Neighbour& b) { return a.distance_squared < b.distance_squared; });
    double left_squared = most_squared;
    for (const Neighbour& n : neighbours_) {
      if (n.offset > 0 && n.offset * n.offset >= n.distance_squared * left_squared) continue;
      polygon_.cut(n.x, n.z, n.offset);
      left_squared = std::min(polygon_.largest_distance_squared(), end_squared);
    }
  }
}

VoronoiCell VoronoiTessellation::cell(std::size_t grain) {
  if (grains_[grain] < 0) return {no_value, false};
  const auto site = static_cast<std::size_t>(grains_[grain]);
  const double x = sites_.x[site], z = sites_.z[site];
  const double end_squared = square(sites_.radius[site]) + tangent_squared_, end = std::sqrt(end_squared);
  // Not tangent to the circle at which the cell ends: roundings would grow there.
  polygon_.make_square(2 * end);
  for (std::size_t grid = 0; grid < largest_.size(); ++grid) cut_by_grid(site, grid);
  const double farthest_squared = polygon_.largest_distance_squared();
  const bool closed = farthest_squared <= end_squared;
  const double from_axis = std::sqrt(x * x + z * z);
  const bool free_of_wall =
      !(container_radius_ > 0) || from_axis + std::sqrt(farthest_squared) <= container_radius_;
  if (closed && free_of_wall) return {polygon_.area(), false};
  const std::array<Circle, 2> discs{Circle{0, 0, end}, Circle{-x, -z, container_radius_}};
  const RoundedArea rounded = area_within(polygon_, std::span(discs).first(container_radius_ > 0 ? 2 : 1));
  return {rounded.area, rounded.length_on_first > 0};
}

std::vector<VoronoiCell> voronoi_cells(const Snapshot& snapshot, double reach) {
  VoronoiTessellation tessellation(snapshot, reach);
  std::vector<VoronoiCell> cells;
  cells.reserve(tessellation.count());
  for (std::size_t i = 0; i < tessellation.count(); ++i) cells.push_back(tessellation.cell(i));
  return cells;
}

}  // namespace drumlin::particles
