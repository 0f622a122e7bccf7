#pragma once
// Whether the linearised equations amplify short waves without bound (ill-posed, Hadamard) at a point of the
// flow.
#include "coupling/core/law/turned_strength.hpp"

namespace drumlin {

/// Smallest value over all directions of the wave of the symbol, divided by a positive factor; negative:
/// ill-posed. A plane wave with normal n and div u = 0 grows at the rate -(|xi|^2/(2 nu)) (F/|D|) S, where,
/// with a = n.(D/|D|).n,
///   S (1 - a F_p) = (1 - r) a^2 - F_p a + 1 - (1 - r) m^2,   r = |D| F_|D| / F,
/// and m = |D|/|D|_regularised bounds |a|. For m = 1 and F = mu(I) p this is the two-dimensional condition of
/// Barker, Schaeffer, Bohorquez & Gray, J. Fluid Mech. 779 (2015): 4 y^2 - 4 y + mu^2 (1 - y/2)^2 <= 0 with y
/// = I mu'/mu. `saturation` is m.
double well_posedness_margin(const Strength& F, double rate, double saturation = 1);

/// How the turn follows the spin of the wave itself; nothing: the turn is frozen.
struct TurnFollowsSpin {
  double spin_ratio = 1;  ///< Wbar/|D|
  double slope = 0;       ///< dB/d(Wbar/|D|), rho0 g d
};

/// The same for the law with k. With the direction of the wave as an angle psi against the axes of D,
/// (x, y) = (cos psi, sin psi), a = m x, b = B/A, R_A = 1 - |D| A_|D|/A, R_B = (B - |D| B_|D|)/A,
///   S (1 - m A_p x + m B_p y) = 1 - m (A_p + b B_p) x + m (B_p - b A_p + m^2 (R_B A_p - R_A B_p)) y
///                               - m^2 R_A y^2 - m^2 R_B x y,
/// plus m t (m A_p - x)(1 + w m y) where the turn follows the spin, t = slope/A, w = spin_ratio. A quadratic
/// form on the unit circle: its minimum comes from the dual problem, which has one maximum, so that no
/// direction is missed.
double well_posedness_margin(const TurnedStrength& F, double rate, double saturation = 1,
                             const TurnFollowsSpin& spin = {.slope = 0});

/// Smallest value of constant + linear.v + v.Q v over |v| = 1, Q = ((xx, xy), (xy, yy)).
struct CircleForm {
  double constant = 0;
  double x = 0, y = 0;
  double xx = 0, xy = 0, yy = 0;
};
double minimum_on_circle(const CircleForm& form);

}  // namespace drumlin
