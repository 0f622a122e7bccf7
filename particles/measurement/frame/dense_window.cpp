#include "particles/measurement/frame/dense_window.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

namespace drumlin::particles {
namespace {

constexpr double cell_size = 4;          // d: a cell of a packing holds a dozen grains
constexpr double least_coverage = 0.05;  // that of the fields of a map (least_map_nu)
constexpr double most_index = 1e15;      // of a cell: beyond it all grains are equally far away

std::int64_t index_of(double place) {
  return static_cast<std::int64_t>(std::clamp(std::floor(place / cell_size), -most_index, most_index));
}

double edge_of(std::int64_t index) { return cell_size * static_cast<double>(index); }

/// Cuts [low, high] to `length`, about `centre` as far as the range allows.
void shorten(double& low, double& high, double length, double centre) {
  if (high - low <= length) return;
  const double from = std::clamp(centre - length / 2, low, high - length);
  low = from;
  high = from + length;
}

}  // namespace

WindowLimits window_limits(std::size_t grains) {
  const auto count = static_cast<double>(grains);
  return {std::max(1e4, 16 * count), std::max(1000.0, 20 * std::sqrt(count))};
}

bool fits(const WindowLimits& limits, const Rectangle& window, double period) {
  const double width = period > 0 ? period : window.width(), height = window.height();
  return height <= limits.height && width * height <= limits.area;
}

void Occupancy::add(const Snapshot& snapshot, const FlowFrame& frame) {
  period_ = snapshot.period_x;
  most_cells_ = std::max(most_cells_, 16 * snapshot.x.size() + 10'000);
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const auto [x, z] = frame.place(snapshot.x[i], snapshot.z[i]);
    if (!std::isfinite(x + z)) continue;
    const double r = snapshot.radius[i];
    Content& content = cells_[{period_ > 0 ? 0 : index_of(x), index_of(z)}];
    content.area += std::numbers::pi * r * r;
    content.reach.widen({x - r, x + r, z - r, z + r});
  }
  ++snapshots_;
  if (cells_.size() > most_cells_) forget_emptier_half();
}

void Occupancy::forget_emptier_half() {
  std::vector<double> areas;
  for (const auto& [cell, content] : cells_) areas.push_back(content.area);
  const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
  std::nth_element(areas.begin(), middle, areas.end());
  std::erase_if(cells_, [&](const auto& entry) { return entry.second.area <= *middle; });
}

Rectangle Occupancy::window(const Rectangle& extent, const WindowLimits& limits) const {
  const Cluster cluster = heaviest_cluster(least_coverage * static_cast<double>(snapshots_));
  const Cluster found = cluster.weight > 0 ? cluster : middle_of_all(extent);
  Rectangle box{std::max(found.box.x_min, extent.x_min), std::min(found.box.x_max, extent.x_max),
                std::max(found.box.z_min, extent.z_min), std::min(found.box.z_max, extent.z_max)};
  shorten(box.z_min, box.z_max, limits.height, found.centre_z);
  if (period_ > 0) {
    box.x_min = extent.x_min;
    box.x_max = extent.x_max;
    shorten(box.z_min, box.z_max, limits.area / period_, found.centre_z);
    return box;
  }
  if (box.area() <= limits.area) return box;
  // A long low window keeps its height, a slender one its width; others are cut to a square.
  shorten(box.z_min, box.z_max, std::max(std::sqrt(limits.area), limits.area / box.width()), found.centre_z);
  shorten(box.x_min, box.x_max, limits.area / box.height(), found.centre_x);
  return box;
}

Occupancy::Cluster Occupancy::heaviest_cluster(double least) const {
  const double least_area = least * cell_size * (period_ > 0 ? period_ : cell_size);
  std::set<Cell> left;
  for (const auto& [cell, content] : cells_)
    if (content.area >= least_area) left.insert(cell);
  Cluster heaviest;
  while (!left.empty()) {
    std::vector<Cell> cells{*left.begin()};
    left.erase(left.begin());
    for (std::size_t k = 0; k < cells.size(); ++k)
      for (std::int64_t column = -1; column <= 1; ++column)
        for (std::int64_t row = -1; row <= 1; ++row)
          if (const Cell beside{cells[k].first + column, cells[k].second + row}; left.erase(beside) > 0)
            cells.push_back(beside);
    if (Cluster cluster = cluster_of(cells); cluster.weight > heaviest.weight) heaviest = cluster;
  }
  return heaviest;
}

Occupancy::Cluster Occupancy::cluster_of(const std::vector<Cell>& cells) const {
  Cluster cluster{0, 0, 0, no_rectangle};
  for (const Cell& cell : cells) {
    const double area = cells_.at(cell).area;
    cluster.weight += area;
    cluster.centre_x += area * (edge_of(cell.first) + cell_size / 2);
    cluster.centre_z += area * (edge_of(cell.second) + cell_size / 2);
    for (std::int64_t column = -1; column <= 1; ++column)
      for (std::int64_t row = -1; row <= 1; ++row)
        if (const auto beside = cells_.find({cell.first + column, cell.second + row}); beside != cells_.end())
          cluster.box.widen(beside->second.reach);
  }
  cluster.centre_x /= cluster.weight;
  cluster.centre_z /= cluster.weight;
  return cluster;
}

Occupancy::Cluster Occupancy::middle_of_all(const Rectangle& extent) const {
  std::map<std::int64_t, double> columns, rows;
  double total = 0;
  for (const auto& [cell, content] : cells_) {
    columns[cell.first] += content.area;
    rows[cell.second] += content.area;
    total += content.area;
  }
  const auto median = [&](const std::map<std::int64_t, double>& areas) {
    double before = 0;
    for (const auto& [index, area] : areas)
      if ((before += area) >= total / 2) return edge_of(index) + cell_size / 2;
    return 0.0;
  };
  return {total, median(columns), median(rows), extent};
}

}  // namespace drumlin::particles
