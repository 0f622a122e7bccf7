#pragma once
// The inertial number, on both sides.
#include <cmath>

namespace drumlin {

/// I of a shear rate, 2 |D| of a rate of strain D, under a pressure: shear_rate d sqrt(rho0/p),
/// dimensionless.
inline double inertial_number(double shear_rate, double p) { return shear_rate / std::sqrt(p); }

}  // namespace drumlin
