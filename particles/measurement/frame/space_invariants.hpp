#pragma once
// What stress and motion in space say without axes, and the differences of normal stresses: one definition
// for layers, rings and maps of spheres (docs/formats/spheres.md).
#include <cmath>
#include <utility>

#include "coupling/core/basics/inertial_number.hpp"
#include "particles/measurement/frame/moments.hpp"

namespace drumlin::particles {

/// NaN where the pressure is not positive.
struct SpaceInvariants {
  double temperature = no_value;  ///< g d
  double p_space = no_value, I_invariant = no_value, mu_invariant = no_value;
  double N1_over_p = no_value, N2_over_p = no_value;
};

/// `strain_rate`: 2 sqrt(D:D/2), of layers their shear rate. Components of the fields x, z, y, those of rings
/// along tangent, radius, y.
inline SpaceInvariants space_invariants(const Fields<3>& fields, double strain_rate) {
  SpaceInvariants result;
  if (fields.nu > 0) result.temperature = trace<3>(fields.kinetic) / (3 * fields.nu);
  const Tensor<3> sigma = fields.pressure();
  const double p = trace<3>(sigma) / 3;
  result.p_space = p;
  if (!(p > 0)) return result;
  double square = 0;  // s:s/2, s the deviator of the symmetric part
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) {
      const double s = (sigma[a][b] + sigma[b][a]) / 2 - (a == b ? p : 0);
      square += s * s / 2;
    }
  result.I_invariant = inertial_number(strain_rate, p);
  result.mu_invariant = std::sqrt(square) / p;
  result.N1_over_p = (sigma[0][0] - sigma[1][1]) / p;
  result.N2_over_p = (sigma[1][1] - sigma[2][2]) / p;
  return result;
}

}  // namespace drumlin::particles
