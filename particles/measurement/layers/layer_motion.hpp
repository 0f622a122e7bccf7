#pragma once
// The mean motion of layers and rings, of discs and of spheres.
#include <cmath>
#include <cstddef>
#include <vector>

#include "particles/measurement/layers/layer_grid.hpp"

namespace drumlin::particles {

/// Mean angular velocity about the centre of rings, clockwise: sum of v_t r / sum of r^2. The spread is that
/// of velocities and, behind them, places, the second one of which counts from the middle of the ring.
template <int N>
double angular_velocity(const Spread<N>& motion, double r) {
  constexpr int zeta = N / 2 + 1;
  const double inertia = motion.product(zeta, zeta) + 2 * r * motion.first[zeta] + motion.weight * r * r;
  return inertia > 0 ? (motion.product(0, zeta) + r * motion.first[0]) / inertia : no_value;
}

/// Slope of v_x: (v[l + 1] - v[l - 1]) / (2 thickness), NaN beside an empty layer and at the ends of an open
/// grid. Beyond those of a cell follow images, which move with it, by `jump` faster above. In rings, whose
/// v_x is the angular velocity, that of v_t/r, times r.
template <class Layer>
void set_shear(const LayerGrid& grid, double jump, std::vector<Layer>& layers) {
  const std::size_t count = layers.size();
  for (std::size_t l = 0; l < count; ++l) {
    const bool lowest = l == 0, highest = l + 1 == count;
    if (count < 2 || (!grid.closed && (lowest || highest))) continue;
    const double above = highest ? layers.front().v_x + jump : layers[l + 1].v_x;
    const double below = lowest ? layers.back().v_x - jump : layers[l - 1].v_x;
    layers[l].shear_rate = (grid.rings ? layers[l].z : 1) * (above - below) / (2 * grid.thickness);
  }
}

/// The slope of v_x within a layer after set_shear(). Of a ring it makes v_x the velocity along the tangent.
template <class Layer>
double slope_within(const LayerGrid& grid, Layer& layer) {
  if (!grid.rings) return layer.shear_rate;
  const double angular = layer.v_x;
  layer.v_x = angular * layer.z;
  return angular + (std::isfinite(layer.shear_rate) ? layer.shear_rate : 0);
}

}  // namespace drumlin::particles
