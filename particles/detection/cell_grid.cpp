#include "particles/detection/cell_grid.hpp"

namespace drumlin::particles {

void CellGrid::sort(const Bodies& bodies, std::span<const double> v_x, std::span<const double> v_z,
                    std::span<const std::int32_t> members, double cell_size, const Period& period) {
  const auto count = static_cast<std::int32_t>(members.size());
  period_ = period;
  double left = bodies.x[members[0]], right = left, low = bodies.z[members[0]], high = low;
  for (const std::int32_t b : members) {
    left = std::min(left, bodies.x[b]), right = std::max(right, bodies.x[b]);
    low = std::min(low, bodies.z[b]), high = std::max(high, bodies.z[b]);
  }
  origin_x_ = period.open() ? left : period.origin;
  origin_z_ = low;
  const double width = period.open() ? right - left : period.length;
  // A stray disc far away must not cost memory: never more than about four cells per grain.
  const double most = 4.0 * count + 16;
  while ((width / cell_size + 1) * ((high - low) / cell_size + 1) > most) cell_size *= 2;
  columns_ = period.open() ? static_cast<int>(width / cell_size) + 1
                           : std::max(1, static_cast<int>(width / cell_size));
  rows_ = static_cast<int>((high - low) / cell_size) + 1;
  cell_x_ = period.open() ? cell_size : period.length / columns_;
  cell_z_ = cell_size;
  cell_of_.resize(count);
  grains_.resize(count);
  start_.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
  for (std::int32_t m = 0; m < count; ++m) {
    const std::int32_t b = members[m];
    const int column =
        std::clamp(static_cast<int>((period.first(bodies.x[b]) - origin_x_) / cell_x_), 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>((bodies.z[b] - origin_z_) / cell_z_), 0, rows_ - 1);
    cell_of_[m] = row * columns_ + column;
    ++start_[cell_of_[m] + 1];
  }
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  next_.assign(start_.begin(), start_.end() - 1);
  for (std::int32_t m = 0; m < count; ++m) {
    const std::int32_t b = members[m];
    grains_[next_[cell_of_[m]]++] = {
        period.first(bodies.x[b]), bodies.z[b], bodies.radius[b], v_x[b], v_z[b], b};
  }
}

void GrainGrids::sort(const Bodies& bodies, std::span<const double> v_x, std::span<const double> v_z,
                      double range, const Period& period) {
  range_ = range;
  const auto [small, large] = std::minmax_element(bodies.radius.begin(), bodies.radius.end());
  const double largest = 2 * *large;
  for (auto& members : members_) members.clear();
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    // A grid holds grains of more than half the diameter of its largest; below the range, size no longer
    // matters.
    const double size = std::max(2 * bodies.radius[b], std::min(range, largest));
    const auto level =
        2 * *small > *large ? 0 : static_cast<std::size_t>(std::floor(std::log2(largest / size)));
    if (level >= members_.size()) members_.resize(level + 1);
    members_[level].push_back(static_cast<std::int32_t>(b));
  }
  used_ = 0;
  largest_.clear();
  for (std::size_t level = 0; level < members_.size(); ++level) {
    if (members_[level].empty()) continue;
    if (used_ == grids_.size()) grids_.emplace_back();
    largest_.push_back(largest / std::exp2(level));
    grids_[used_++].sort(bodies, v_x, v_z, members_[level], largest_.back() + range, period);
  }
}

}  // namespace drumlin::particles
