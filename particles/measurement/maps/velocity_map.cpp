#include "particles/measurement/maps/velocity_map.hpp"

#include <cmath>

namespace drumlin::particles {

void VelocityMap::add(const FlowSnapshot& snapshot) {
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) {
    const auto [column, row] = grid_.place(snapshot.x[i], snapshot.z[i]);
    if (const auto cell = grid_.cell(std::floor(column), std::floor(row)))
      cells_[*cell].add(1, {snapshot.v_x[i], snapshot.v_z[i]});
  }
}

Vector<2> VelocityMap::at(double x, double z) const {
  constexpr double least_grains = 10;
  double grains = 0;
  Spread<2> around;
  grid_.each_around(x, z, [&](std::size_t cell, double weight) {
    const Spread<2>& sum = cells_[cell];
    if (sum.weight == 0) return;
    grains += sum.weight;
    around.add(weight, {sum.mean(0), sum.mean(1)});
  });
  if (grains < least_grains) return {no_value, no_value};
  return {around.mean(0), around.mean(1)};
}

}  // namespace drumlin::particles
