#pragma once
// Flows that can be written down, for mu = a + b ln I; what the finite elements are held against.
#include "continuum/rheology/stress_law.hpp"

namespace drumlin {

/// I at which the law gives this friction.
double inertial_number(const LogLaw& law, double mu);

/// Bagnold's flow down an incline: layer of height `height` and density nu on a rough bottom at slope theta
/// (rad), free at the top. Speed at the height z above the bottom: 2/3 I0 sqrt(nu cos theta) (H^1.5 - (H -
/// z)^1.5), mu(I0) = tan theta (GDR MiDi, Eur. Phys. J. E 14 (2004), with this law).
double bagnold_speed(const LogLaw& law, double nu, double theta, double height, double z);

/// Plane shear under the pressure P and the shear stress mu P: the rate I sqrt(P), uniform.
double plane_shear_rate(const LogLaw& law, double pressure, double shear_stress);

/// Vertical chute between rough walls at |y| = half_width under the pressure P, weight nu along it:
/// u = sqrt(P) (b P/nu) e^(-a/b) (e^(nu W/(b P)) - e^(nu y/(b P))), y >= 0 from the middle.
double vertical_chute_speed(const LogLaw& law, double nu, double pressure, double half_width, double y);

}  // namespace drumlin
