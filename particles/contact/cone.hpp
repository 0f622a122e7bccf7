#pragma once
// The laws of one contact, as cones. The number of unknowns of a contact is a property of the type, chosen
// once per solve: a scene without friction has one unknown per contact and never meets a branch about
// friction.
#include <algorithm>
#include <cmath>

namespace drumlin::particles {

/// Signorini alone: 0 <= u_n, r_n >= 0, u_n r_n = 0.
struct Frictionless {
  static constexpr int dim = 1;
};

/// Signorini and Coulomb: r in K = {|r_t| <= mu r_n}, sliding opposes r_t. Components (normal, tangential).
struct Coulomb {
  static constexpr int dim = 2;
};

/// Signorini, Coulomb and rolling resistance: r in K = {|r_t| <= mu r_n, |r_r| <= mu_r r_n}, sliding opposes
/// r_t, rolling r_r. Components (normal, tangential, rolling); the rolling velocity is R_eff (omega_i -
/// omega_j) with 1/R_eff = 1/r_i + 1/r_j, a wall counting as flat, so that r_r is an impulse and R_eff r_r
/// its couple (Estrada, Azema, Radjai, Taboada 2011).
struct CoulombRolling {
  static constexpr int dim = 3;
};

/// Friction above this is steep: what a step of the normal impulse does to friction outweighs the step
/// itself.
inline constexpr double steep_friction = 1;

/// Part of its way that a sweep lets the normal impulse of a contact go, steep or not, from impulses (n, t);
/// the whole way would lead to n = `whole` and, without a bound, t = `free`. Friction of a contact that
/// slides follows n mu-fold, and neighbours answer to friction: steep contacts that slide would swing for
/// ever.
inline double share_of_way(double mu, double n, double t, double whole, double free) {
  const bool slides = (n > 0 && std::abs(t) >= 0.999 * (mu * n)) || std::abs(free) >= mu * whole;
  return mu > steep_friction && slides ? 1 / mu : 1;
}

/// Euclidean projection of (n, t) on K = {|t| <= mu n}, in place. Without branches, which nobody could
/// foretell: contacts open, slide and stick at random. A NaN stays one.
inline void project_on_cone(double mu, double& n, double& t) {
  const double size = std::abs(t), above = std::max(n, 0.0);
  const double along = std::max(n + mu * size, 0.0) / (1 + mu * mu);  // on the ray or the tip
  const bool inside = size <= mu * above;
  t = inside ? t : std::copysign(mu * along, t);
  n = inside ? above : along;
}

/// Euclidean projection of (n, t, r) on K = {|t| <= mu n, |r| <= mu_r n}, in place. For given n the best t
/// and r are clamped; the derivative of what is left, n' - n - mu (|t| - mu n')+ - mu_r (|r| - mu_r n')+,
/// rises and is the least of four lines (each of t and r clamped or not), so that its zero is the largest of
/// theirs.
inline void project_on_cone(double mu, double mu_r, double& n, double& t, double& r) {
  const double with_t = mu * std::abs(t), with_r = mu_r * std::abs(r);
  const double along = std::max({0.0, n, (n + with_t) / (1 + mu * mu), (n + with_r) / (1 + mu_r * mu_r),
                                 (n + with_t + with_r) / (1 + mu * mu + mu_r * mu_r)});
  n = along;
  t = std::clamp(t, -mu * n, mu * n);
  r = std::clamp(r, -mu_r * n, mu_r * n);
}

}  // namespace drumlin::particles
