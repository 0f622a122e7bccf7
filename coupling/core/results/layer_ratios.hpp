#pragma once
// The numbers of a shear flow in layers, from the stress and the shear rate: one definition for both sides.
#include "coupling/core/basics/inertial_number.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/results/profile_set.hpp"

namespace drumlin {

/// Compression positive; xz is the traction of what is above on what is below.
struct LayerStress {
  double xx = 0, zz = 0, xz = 0;
};

/// NaN where sigma_zz is not positive.
struct LayerRatios {
  double I = no_value, mu = no_value, k = no_value;
};

/// I = shear_rate/sqrt(sigma_zz), mu = sigma_xz/sigma_zz, k = sigma_xx/sigma_zz. This mu is not
/// tau:D/(2 |D| p), that of a law: in a creeping bed their axes differ (docs/theory/measurement.md).
inline LayerRatios layer_ratios(const LayerStress& sigma, double shear_rate) {
  if (!(sigma.zz > 0)) return {};
  return {inertial_number(shear_rate, sigma.zz), sigma.xz / sigma.zz, sigma.xx / sigma.zz};
}

/// Appends the columns I, mu and k of layers, from those of the shear rate and the stresses; with intervals
/// where both parts of a ratio have them, their relative errors independent.
void add_layer_ratios(ProfileSet& set);

}  // namespace drumlin
