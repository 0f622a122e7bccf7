#pragma once
// Coulomb friction at a point of a wall, and its derivative. Private to fem/.
#include <algorithm>
#include <cmath>

#include "continuum/model/flow_problem.hpp"

namespace drumlin::continuum::fem {

/// Traction of the material on the wall along the sliding direction.
struct WallFriction {
  double traction = 0;
  double by_slip = 0;
  double by_pressure = 0;
};

/// `slip`: speed of the material along the wall against it; p: pressure of the material.
inline WallFriction wall_friction(const FrictionWall& wall, const Regularisation& r, double slip, double p) {
  const RegularisedPressure pressure = regularised_pressure(p, r);
  const double slip_speed = std::max(wall.slip_speed, 3 * r.shear_rate);
  const double length = std::sqrt(slip * slip + slip_speed * slip_speed);
  return {.traction = wall.friction * pressure.value * slip / length,
          .by_slip = wall.friction * pressure.value * slip_speed * slip_speed / (length * length * length),
          .by_pressure = wall.friction * pressure.slope * slip / length};
}

}  // namespace drumlin::continuum::fem
