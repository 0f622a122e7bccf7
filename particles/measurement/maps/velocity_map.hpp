#pragma once
// Map of the mean velocity in the flow frame, from which fluctuations of single grains are counted.
#include <array>
#include <cstddef>
#include <vector>

#include "particles/measurement/frame/flow_snapshot.hpp"

namespace drumlin::particles {

/// Means over the grains whose centres lie in square cells of 1 d, over all snapshots added.
class VelocityMap {
 public:
  /// Cells over what the grains reach. `period` > 0: x is brought back into x_min ... x_min + period.
  VelocityMap(double x_min, double x_max, double z_min, double z_max, double period = 0);
  void add(const FlowSnapshot& snapshot);
  /// (v_x, v_z), linear between the middles of the cells that hold grains; NaN where fewer than ten grains
  /// stand behind it.
  std::array<double, 2> at(double x, double z) const;

 private:
  /// The cell of column and row, or null beyond the map; columns of a period follow each other round.
  const Spread<2>* sum_at(double column, double row) const;
  double wrapped(double x) const;

  double x_min_, z_min_, period_, cell_x_ = 1;
  std::size_t columns_, rows_;
  std::vector<Spread<2>> cells_;
};

}  // namespace drumlin::particles
