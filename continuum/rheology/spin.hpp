#pragma once
// Rate at which the material rotates relative to its axes of strain rate; its sign decides to which side k
// turns the stress.
#include <cmath>

#include "continuum/rheology/plane_tensor.hpp"

namespace drumlin::continuum {

/// Spin of D's eigenframe along the path of the material, in the sense of dv_x/dz: Omega_D = -d(angle)/dt
/// with the angle of the axes counted from x towards z. D_dot: material derivative of D, v.grad D in a steady
/// flow; `rate`: regularised |D|. Nought where D is.
inline double eigenframe_spin(const PlaneTensor& D, const PlaneTensor& D_dot, double rate) {
  const double a = 0.5 * (D.xx - D.zz), b = D.xz;
  const double a_dot = 0.5 * (D_dot.xx - D_dot.zz), b_dot = D_dot.xz;
  return -(a * b_dot - b * a_dot) / (2 * rate * rate);
}

/// s sgn(Wbar) = sqrt(1 + c^2) Wbar/sqrt(Wbar^2 + c^2 |D|^2) for the relative spin Wbar = (dv_x/dz -
/// dv_z/dx)/2 - Omega_D, the same for every observer: 1 in simple shear, 0 in pure extension, smooth between.
/// `softness` is c.
inline double turn_of(double relative_spin, double rate, double softness = 0.1) {
  return std::sqrt(1 + softness * softness) * relative_spin / std::hypot(relative_spin, softness * rate);
}

}  // namespace drumlin::continuum
