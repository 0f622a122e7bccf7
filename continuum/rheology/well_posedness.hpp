#pragma once
// Whether the linearised equations amplify short waves without bound (ill-posed, Hadamard) at a point of the
// flow.
#include "continuum/rheology/stress_law.hpp"

namespace drumlin {

/// Smallest value over all directions of the wave of the symbol, divided by a positive factor; negative:
/// ill-posed. A plane wave with normal n and div u = 0 grows at the rate -(|xi|^2/(2 nu)) (F/|D|) S, where,
/// with a = n.(D/|D|).n,
///   S (1 - a F_p) = (1 - r) a^2 - F_p a + 1 - (1 - r) m^2,   r = |D| F_|D| / F,
/// and m = |D|/|D|_regularised bounds |a|. For m = 1 and F = mu(I) p this is the two-dimensional condition of
/// Barker, Schaeffer, Bohorquez & Gray, J. Fluid Mech. 779 (2015): 4 y^2 - 4 y + mu^2 (1 - y/2)^2 <= 0 with y
/// = I mu'/mu. `saturation` is m.
double well_posedness_margin(const Strength& F, double rate, double saturation = 1);

}  // namespace drumlin
