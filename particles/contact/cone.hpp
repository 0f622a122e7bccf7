#pragma once
// The laws of one contact, as cones. The number of unknowns of a contact is a property of the type, chosen
// once per solve: a scene without friction has one unknown per contact and never meets a branch about
// friction.
#include <algorithm>
#include <cmath>

namespace drumlin {

/// Signorini alone: 0 <= u_n, r_n >= 0, u_n r_n = 0.
struct Frictionless {
  static constexpr int dim = 1;
};

/// Signorini and Coulomb: r in K = {|r_t| <= mu r_n}, sliding opposes r_t. Components (normal, tangential).
struct Coulomb {
  static constexpr int dim = 2;
};

/// Euclidean projection of (n, t) on K = {|t| <= mu n}, in place.
inline void project_on_cone(double mu, double& n, double& t) {
  const double size = std::abs(t);
  if (n >= 0 && size <= mu * n) return;  // 0 <= 0 * n for any n where mu = 0
  if (mu * size <= -n) {
    n = t = 0;
    return;
  }
  const double along = (n + mu * size) / (1 + mu * mu);
  t = std::copysign(mu * along, t);
  n = along;
}

}  // namespace drumlin
