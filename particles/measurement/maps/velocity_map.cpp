#include "particles/measurement/maps/velocity_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drumlin::particles {
namespace {

constexpr double least_grains = 10;

std::size_t cells_over(double length) { return static_cast<std::size_t>(std::max(1.0, std::ceil(length))); }

}  // namespace

VelocityMap::VelocityMap(double x_min, double x_max, double z_min, double z_max, double period)
    : x_min_(x_min),
      z_min_(z_min),
      period_(period),
      columns_(cells_over(period > 0 ? period : x_max - x_min)),
      rows_(cells_over(z_max - z_min)),
      cells_(columns_ * rows_) {
  if (period > 0) cell_x_ = period / static_cast<double>(columns_);
}

double VelocityMap::wrapped(double x) const {
  return period_ > 0 ? x - period_ * std::floor((x - x_min_) / period_) : x;
}

const Spread<2>* VelocityMap::sum_at(double column, double row) const {
  const auto columns = static_cast<double>(columns_);
  if (period_ > 0) column -= columns * std::floor(column / columns);
  if (!(column >= 0 && column < columns && row >= 0 && row < static_cast<double>(rows_))) return nullptr;
  return &cells_[static_cast<std::size_t>(row) * columns_ + static_cast<std::size_t>(column)];
}

void VelocityMap::add(const FlowSnapshot& snapshot) {
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const Spread<2>* const found =
        sum_at(std::floor((wrapped(snapshot.x[i]) - x_min_) / cell_x_), std::floor(snapshot.z[i] - z_min_));
    if (found != nullptr) cells_[found - cells_.data()].add(1, {snapshot.v_x[i], snapshot.v_z[i]});
  }
}

std::array<double, 2> VelocityMap::at(double x, double z) const {
  const double along = (wrapped(x) - x_min_) / cell_x_ - 0.5, up = z - z_min_ - 0.5;
  const double column = std::floor(along), row = std::floor(up);
  double weights = 0, grains = 0, v_x = 0, v_z = 0;
  for (const double right : {0.0, 1.0})
    for (const double above : {0.0, 1.0}) {
      const Spread<2>* const sum = sum_at(column + right, row + above);
      if (sum == nullptr || sum->weight == 0) continue;
      const double weight = (1 - std::abs(along - column - right)) * (1 - std::abs(up - row - above));
      weights += weight;
      grains += sum->weight;
      v_x += weight * sum->first[0] / sum->weight;
      v_z += weight * sum->first[1] / sum->weight;
    }
  if (grains < least_grains || !(weights > 0))
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  return {v_x / weights, v_z / weights};
}

}  // namespace drumlin::particles
