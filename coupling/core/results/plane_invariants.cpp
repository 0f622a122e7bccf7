#include "coupling/core/results/plane_invariants.hpp"

#include <cmath>
#include <numbers>

#include "coupling/core/basics/inertial_number.hpp"

namespace drumlin {

double nearest_turn(double angle, double period) { return angle - period * std::round(angle / period); }

double axis_angle_deg(const PlaneMatrix& pressure, const PlaneMatrix& gradient) {
  const double of_pressure = std::atan2(pressure.xz + pressure.zx, pressure.xx - pressure.zz) / 2;
  const double of_shortening = std::atan2(-(gradient.xz + gradient.zx), gradient.zz - gradient.xx) / 2;
  return nearest_turn((of_pressure - of_shortening) * 180 / std::numbers::pi, 180);
}

PlaneInvariants plane_invariants(const PlaneMatrix& pressure, const PlaneMatrix& gradient) {
  PlaneInvariants at;
  const double D_xz = (gradient.xz + gradient.zx) / 2;
  at.strain_rate =
      2 * std::sqrt((gradient.xx * gradient.xx + 2 * D_xz * D_xz + gradient.zz * gradient.zz) / 2);
  at.half_vorticity = (gradient.xz - gradient.zx) / 2;
  at.p = (pressure.xx + pressure.zz) / 2;
  at.tau = std::hypot((pressure.xx - pressure.zz) / 2, (pressure.xz + pressure.zx) / 2);
  if (!(at.p > 0)) return at;
  at.I = inertial_number(at.strain_rate, at.p);
  at.mu = at.tau / at.p;
  if (pressure.zz > 0) at.k = pressure.xx / pressure.zz;
  at.axis_angle_deg = axis_angle_deg(pressure, gradient);
  return at;
}

}  // namespace drumlin
