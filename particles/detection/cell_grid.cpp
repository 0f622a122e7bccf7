#include "particles/detection/cell_grid.hpp"

namespace drumlin {

void CellGrid::sort(const Bodies& bodies, double cell_size, const Period& period) {
  const auto count = static_cast<std::int32_t>(bodies.count());
  period_ = period;
  const auto [left, right] = std::minmax_element(bodies.x.begin(), bodies.x.end());
  const auto [low, high] = std::minmax_element(bodies.z.begin(), bodies.z.end());
  origin_x_ = *left;
  origin_z_ = *low;
  const double width = period.open() ? *right - *left : period.length;
  // A stray disc far away must not cost memory: never more than about four cells per grain.
  const double most = 4.0 * count + 16;
  while ((width / cell_size + 1) * ((*high - *low) / cell_size + 1) > most) cell_size *= 2;
  columns_ = period.open() ? static_cast<int>(width / cell_size) + 1
                           : std::max(1, static_cast<int>(width / cell_size));
  rows_ = static_cast<int>((*high - *low) / cell_size) + 1;
  cell_x_ = period.open() ? cell_size : period.length / columns_;
  cell_z_ = cell_size;
  cell_of_.resize(count);
  grains_.resize(count);
  start_.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
  for (std::int32_t b = 0; b < count; ++b) {
    const double x = period.open() ? bodies.x[b] - origin_x_ : period.first(bodies.x[b]) - period.origin;
    const int column = std::clamp(static_cast<int>(x / cell_x_), 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>((bodies.z[b] - origin_z_) / cell_z_), 0, rows_ - 1);
    cell_of_[b] = row * columns_ + column;
    ++start_[cell_of_[b] + 1];
  }
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  next_.assign(start_.begin(), start_.end() - 1);
  for (std::int32_t b = 0; b < count; ++b) grains_[next_[cell_of_[b]]++] = b;
}

}  // namespace drumlin
