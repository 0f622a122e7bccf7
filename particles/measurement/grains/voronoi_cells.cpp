#include "particles/measurement/grains/voronoi_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "coupling/core/basics/no_value.hpp"
#include "particles/bodies/cell_path.hpp"

namespace drumlin::particles {
namespace {

constexpr double mean_weight = 0.25;  // of a grain of diameter 1

int floor_divided(int a, int b) { return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0); }

/// Beginning and length of the range that holds the middle 98 % of some sites.
template <class Site>
std::pair<double, double> middle_part(const std::vector<Site>& sites, double Site::*place) {
  std::vector<double> places;
  for (const Site& site : sites) places.push_back(site.*place);
  std::sort(places.begin(), places.end());
  const std::size_t rim = places.size() / 100 + 1;
  if (places.size() <= 2 * rim) return {places.front(), places.back() - places.front()};
  return {places[rim], places[places.size() - 1 - rim] - places[rim]};
}

/// The period of a snapshot; of one that is open in z it may begin anywhere.
Period domain_of(const Snapshot& snapshot) {
  Period period = period_of(snapshot);
  if (period.open()) period.length = snapshot.period_x;
  return period;
}

int cell_at(double x, double x_min, double size) {
  return static_cast<int>(std::clamp(std::floor((x - x_min) / size), -1e9, 1e9));
}

}  // namespace

VoronoiTessellation::VoronoiTessellation(const Snapshot& snapshot, const VoronoiOptions& options)
    // What is inside a circle knows no period.
    : period_(snapshot.container_radius > 0 ? Period{} : domain_of(snapshot)),
      container_radius_(snapshot.container_radius),
      tangent_squared_(options.reach * options.reach - mean_weight) {
  // No place of a cell that is periodic in both directions is half as far from an image of a grain.
  if (!period_.open_z())
    tangent_squared_ = period_.length * period_.length + period_.length_z * period_.length_z;
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  grains_.reserve(snapshot.x.size());
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const double r = snapshot.radius[i];
    Point at{snapshot.x[i], snapshot.z[i]};
    if (container_radius_ > 0) at.x -= snapshot.container_x, at.z -= snapshot.container_z;
    const auto [x, z] = period_.first(at);
    const bool inside = !(container_radius_ > 0) || x * x + z * z <= container_radius_ * container_radius_;
    const bool takes_part = inside && std::isfinite(x + z) && std::isfinite(r) && r > 0;
    const double weight = options.tessellation == Tessellation::radical ? r * r : mean_weight;
    grains_.push_back({x, z, weight, takes_part ? static_cast<std::int32_t>(i) : -1});
    if (!takes_part) continue;
    smallest = std::min(smallest, r);
    largest = std::max(largest, r);
  }
  // A level holds grains of more than half the size of its largest: a search among small grains need not
  // reach as far as one among large ones.
  std::vector<std::vector<Site>> members;
  for (const Site& site : grains_) {
    if (site.grain < 0) continue;
    const double r = snapshot.radius[static_cast<std::size_t>(site.grain)];
    const auto level =
        2 * smallest > largest ? 0 : static_cast<std::size_t>(std::floor(std::log2(largest / r)));
    if (level >= members.size()) members.resize(level + 1);
    members[level].push_back(site);
  }
  for (std::size_t level = 0; level < members.size(); ++level)
    if (!members[level].empty())
      levels_.push_back(
          sorted_level(std::move(members[level]), 2 * largest / std::exp2(static_cast<double>(level))));
}

VoronoiTessellation::Level VoronoiTessellation::sorted_level(std::vector<Site> sites,
                                                             double largest_diameter) const {
  Level level;
  const auto [west, east] =
      std::minmax_element(sites.begin(), sites.end(), [](auto& a, auto& b) { return a.x < b.x; });
  const auto [low, high] =
      std::minmax_element(sites.begin(), sites.end(), [](auto& a, auto& b) { return a.z < b.z; });
  const bool round_x = !period_.open(), round_z = !period_.open_z();
  level.x_min = round_x ? period_.origin : west->x;
  level.z_min = round_z ? period_.origin_z : low->z;
  double width = round_x ? period_.length : east->x - west->x;
  double height = round_z ? period_.length_z : high->z - low->z;
  // A stray grain far away must not cost memory...
  const auto cell_for = [&] {
    double size = largest_diameter;
    while ((width / size + 1) * (height / size + 1) > 4.0 * static_cast<double>(sites.size()) + 16) size *= 2;
    return size;
  };
  double size = cell_for();
  if (size > 4 * largest_diameter) {
    // ... nor time, by cells that hold hundreds of grains: cells cover the middle 98 %, those at the rim hold
    // what is further out.
    if (!round_x) std::tie(level.x_min, width) = middle_part(sites, &Site::x);
    if (!round_z) std::tie(level.z_min, height) = middle_part(sites, &Site::z);
    size = cell_for();
  }
  level.columns = std::max(1, static_cast<int>(width / size) + (round_x ? 0 : 1));
  level.rows = std::max(1, static_cast<int>(height / size) + (round_z ? 0 : 1));
  level.cell_x = round_x ? width / level.columns : size;
  level.cell_z = round_z ? height / level.rows : size;
  // In a dense packing corners lie within 0.7 diameters, so that neighbours within 1.5 settle nearly every
  // cell.
  level.first_reach = 1.5 * largest_diameter;
  level.largest_weight = 0;
  level.start.assign(static_cast<std::size_t>(level.columns) * level.rows + 1, 0);
  std::vector<std::int32_t> cell_of;
  cell_of.reserve(sites.size());
  for (const Site& site : sites) {
    const int column = std::clamp(cell_at(site.x, level.x_min, level.cell_x), 0, level.columns - 1);
    const int row = std::clamp(cell_at(site.z, level.z_min, level.cell_z), 0, level.rows - 1);
    cell_of.push_back(row * level.columns + column);
    ++level.start[cell_of.back() + 1];
    level.largest_weight = std::max(level.largest_weight, site.weight);
  }
  for (std::size_t c = 1; c < level.start.size(); ++c) level.start[c] += level.start[c - 1];
  std::vector<std::int32_t> next(level.start.begin(), level.start.end() - 1);
  level.sites.resize(sites.size());
  for (std::size_t s = 0; s < sites.size(); ++s) level.sites[next[cell_of[s]]++] = sites[s];
  return level;
}

bool VoronoiTessellation::gather(const Site& site, const Level& level, double reach, double most_squared) {
  neighbours_.clear();
  // Beyond the ends of a period stand its images, the grain's own among them.
  int first_row = cell_at(site.z - reach, level.z_min, level.cell_z);
  int last_row = cell_at(site.z + reach, level.z_min, level.cell_z);
  if (period_.open_z()) {
    first_row = std::clamp(first_row, 0, level.rows - 1);
    last_row = std::clamp(last_row, 0, level.rows - 1);
  }
  for (int row = first_row; row <= last_row; ++row) {
    const int above = period_.open_z() ? 0 : floor_divided(row, level.rows);
    const int row_start = (row - above * level.rows) * level.columns;
    const Point shift{above * period_.offset, above * period_.length_z};
    if (!gather_row(site, level, row_start, shift, reach, most_squared)) return false;
  }
  return true;
}

bool VoronoiTessellation::gather_row(const Site& site, const Level& level, int row_start, Point shift,
                                     double reach, double most_squared) {
  int first_column = cell_at(site.x - shift.x - reach, level.x_min, level.cell_x);
  int last_column = cell_at(site.x - shift.x + reach, level.x_min, level.cell_x);
  if (period_.open()) {
    first_column = std::clamp(first_column, 0, level.columns - 1);
    last_column = std::clamp(last_column, 0, level.columns - 1);
  }
  const int first_image = period_.open() ? 0 : floor_divided(first_column, level.columns);
  const int last_image = period_.open() ? 0 : floor_divided(last_column, level.columns);
  for (int image = first_image; image <= last_image; ++image) {
    // Cells side by side are one stretch of sites.
    const int image_start = image * level.columns;
    const int begin = std::max(first_column - image_start, 0);
    const int end = std::min(last_column - image_start + 1, level.columns);
    if (begin >= end) continue;
    const double shift_x = image * period_.length + shift.x - site.x;
    for (std::int32_t s = level.start[row_start + begin]; s < level.start[row_start + end]; ++s) {
      const Site& other = level.sites[s];
      const double x = other.x + shift_x, z = other.z + shift.z - site.z;
      const double distance_squared = x * x + z * z;
      if (distance_squared == 0) {
        if (other.grain == site.grain) continue;
        if (other.weight > site.weight || (other.weight == site.weight && other.grain < site.grain))
          return false;
        continue;
      }
      const double offset = (distance_squared + site.weight - other.weight) / 2;
      if (offset > 0 && offset * offset >= distance_squared * most_squared) continue;  // passes by
      neighbours_.push_back({x, z, distance_squared, offset});
    }
  }
  return true;
}

void VoronoiTessellation::cut_by_level(const Site& site, const Level& level) {
  const double end_squared = site.weight + tangent_squared_;
  double searched = 0;
  while (!polygon_.empty()) {
    const double most_squared = std::min(polygon_.largest_distance_squared(), end_squared);
    // Lines that come nearer than `most` belong to centres no farther than this.
    const double needed =
        std::sqrt(most_squared) + std::sqrt(std::max(0.0, most_squared + level.largest_weight - site.weight));
    if (searched >= needed) return;
    searched = searched == 0 ? std::min(needed, level.first_reach) : needed;
    if (!gather(site, level, searched, most_squared)) {
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
  const Site& site = grains_[grain];
  if (site.grain < 0) return {no_value, false};
  const double end_squared = site.weight + tangent_squared_, end = std::sqrt(end_squared);
  polygon_.make_square(2 *
                       end);  // not tangent to the circle at which the cell ends: roundings would grow there
  for (const Level& level : levels_) cut_by_level(site, level);
  const double farthest_squared = polygon_.largest_distance_squared();
  const bool closed = farthest_squared <= end_squared;
  const double from_axis = std::sqrt(site.x * site.x + site.z * site.z);
  const bool free_of_wall =
      !(container_radius_ > 0) || from_axis + std::sqrt(farthest_squared) <= container_radius_;
  if (closed && free_of_wall) return {polygon_.area(), false};
  const std::array<Circle, 2> discs{Circle{0, 0, end}, Circle{-site.x, -site.z, container_radius_}};
  const RoundedArea rounded = area_within(polygon_, std::span(discs).first(container_radius_ > 0 ? 2 : 1));
  return {rounded.area, rounded.length_on_first > 0};
}

std::vector<VoronoiCell> voronoi_cells(const Snapshot& snapshot, const VoronoiOptions& options) {
  VoronoiTessellation tessellation(snapshot, options);
  std::vector<VoronoiCell> cells;
  cells.reserve(tessellation.count());
  for (std::size_t i = 0; i < tessellation.count(); ++i) cells.push_back(tessellation.cell(i));
  return cells;
}

}  // namespace drumlin::particles
