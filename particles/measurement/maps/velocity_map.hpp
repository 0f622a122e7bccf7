#pragma once
// Map of the mean velocity in the flow frame, from which fluctuations of single grains are counted.
#include <vector>

#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/frame/unit_cells.hpp"

namespace drumlin::particles {

/// Means over the grains whose centres lie in square cells of 1 d, over all snapshots added.
class VelocityMap {
 public:
  /// Over what the grains reach. `period` > 0: of x.
  explicit VelocityMap(const Rectangle& reach, double period = 0)
      : grid_(reach, period), cells_(grid_.cells()) {}
  void add(const FlowSnapshot& snapshot);
  /// (v_x, v_z), linear between the middles of the cells that hold grains; NaN where fewer than ten grains
  /// stand behind it.
  Vector<2> at(double x, double z) const;

 private:
  UnitCells grid_;
  std::vector<Spread<2>> cells_;
};

}  // namespace drumlin::particles
