#include "particles/contact/block_delassus.hpp"

#include <algorithm>
#include <limits>

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

namespace {

/// Where a sweep lets a contact of steep friction go that would go from `old` to `whole`.
Eigen::Vector2d part_of_way(const Eigen::Matrix2d& W, const Eigen::Vector2d& q, double mu,
                            const Eigen::Vector2d& old, const Eigen::Vector2d& whole) {
  const double share = share_of_way(mu, old[0], old[1], whole[0], whole[1]);
  if (share == 1) return whole;
  const double u_n = W.row(0).dot(old) + q[0];
  const double r_n = std::max(0.0, old[0] - u_n * (share / W(0, 0)));
  return {r_n, std::clamp(-(W(1, 0) * r_n + q[1]) / W(1, 1), -mu * r_n, mu * r_n)};
}

}  // namespace

Eigen::Vector2d BlockDelassus::row_times(int a, std::span<const double> r) const {
  Eigen::Vector2d u = Eigen::Vector2d::Zero();
  for (int k = row_start[a]; k < row_start[a + 1]; ++k)
    u.noalias() += block[k] * Eigen::Map<const Eigen::Vector2d>(&r[2 * column[k]]);
  return u;
}

double BlockDelassus::largest_eigenvalue(int a) const {
  const auto& W = diagonal[a];
  const double mean = (W(0, 0) + W(1, 1)) / 2, half = (W(0, 0) - W(1, 1)) / 2;
  // One square: the product of two entries that differ by rounding can be negative.
  const double off = (W(0, 1) + W(1, 0)) / 2;
  return mean + std::sqrt(half * half + off * off);
}

void BlockDelassus::velocities(std::span<const double> r, std::span<const double> q, State&,
                               std::vector<double>& u) const {
  u.resize(q.size());
  for (int a = 0; a < contacts(); ++a) {
    const Eigen::Vector2d W_r = row_times(a, r);
    u[2 * a] = q[2 * a] + W_r[0];
    u[2 * a + 1] = q[2 * a + 1] + W_r[1];
  }
}

double BlockDelassus::sweep(std::span<const double> q, std::span<const double> mu, std::span<double> r,
                            State& state, std::span<double> step) const {
  double sum = 0;
  for (int a = 0; a < contacts(); ++a) {
    const Eigen::Vector2d old(state[2 * a], state[2 * a + 1]);
    const Eigen::Vector2d free =
        row_times(a, state) - diagonal[a] * old + Eigen::Vector2d(q[2 * a], q[2 * a + 1]);
    Eigen::Vector2d fresh = solve_planar_contact(diagonal[a], free, mu[a]);
    if (mu[a] > steep_friction) fresh = part_of_way(diagonal[a], free, mu[a], old, fresh);
    for (int c = 0; c < 2; ++c) {
      state[2 * a + c] = r[2 * a + c] = fresh[c];
      step[2 * a + c] = fresh[c] - old[c];
    }
    sum += (fresh - old).squaredNorm();
  }
  return sum;
}

}  // namespace drumlin::particles
