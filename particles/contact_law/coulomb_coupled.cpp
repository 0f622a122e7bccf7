#include "particles/contact_law/coulomb_coupled.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "particles/contact_law/laws.hpp"

namespace drumlin::particles {

Eigen::Vector2d solve_planar_contact(const Eigen::Matrix2d& W, const Eigen::Vector2d& q, double mu) {
  if (q[0] >= 0) return Eigen::Vector2d::Zero();
  const double determinant = W.determinant();
  if (determinant > 0) {
    const Eigen::Vector2d stick(-(W(1, 1) * q[0] - W(0, 1) * q[1]) / determinant,
                                -(W(0, 0) * q[1] - W(1, 0) * q[0]) / determinant);
    if (stick[0] >= 0 && std::abs(stick[1]) <= mu * stick[0]) return stick;
  }
  // Sliding with r_t = s mu r_n needs u_t of the sign -s; where both or neither fit (|W_nt| large), the one
  // whose wrong sliding velocity is smaller.
  Eigen::Vector2d best = Eigen::Vector2d::Zero();
  double best_fault = std::numeric_limits<double>::infinity();
  for (const double s : {1.0, -1.0}) {
    const double stiffness = W(0, 0) + s * mu * W(0, 1);
    if (stiffness <= 0) continue;
    const double r_n = -q[0] / stiffness;
    const double u_t = W(1, 0) * r_n + W(1, 1) * s * mu * r_n + q[1];
    const double fault = std::max(0.0, s * u_t);
    if (fault < best_fault) {
      best_fault = fault;
      best = {r_n, s * mu * r_n};
    }
  }
  return best;
}

Eigen::Vector2d solved_coupled(const Eigen::Matrix2d& W, const Eigen::Vector2d& q, double mu,
                               const Eigen::Vector2d& old) {
  const Eigen::Vector2d whole = solve_planar_contact(W, q, mu);
  if (!contact_law::steep(mu)) return whole;
  const double fraction = contact_law::step_fraction(mu, old[0], old[1], whole[0], whole[1]);
  if (fraction == 1) return whole;
  const double u_n = W.row(0).dot(old) + q[0];
  const double r_n = std::max(0.0, old[0] - u_n * (fraction / W(0, 0)));
  return {r_n, std::clamp(-(W(1, 0) * r_n + q[1]) / W(1, 1), -mu * r_n, mu * r_n)};
}

}  // namespace drumlin::particles
