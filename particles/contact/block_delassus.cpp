#include "particles/contact/block_delassus.hpp"

#include <algorithm>

#include "particles/contact_law/laws.hpp"

namespace drumlin::particles {

Eigen::Vector2d BlockDelassus::row_times(int a, std::span<const double> r) const {
  Eigen::Vector2d u = Eigen::Vector2d::Zero();
  for (int k = row_start[a]; k < row_start[a + 1]; ++k)
    u.noalias() += block[k] * Eigen::Map<const Eigen::Vector2d>(&r[2 * column[k]]);
  return u;
}

double BlockDelassus::largest_eigenvalue(int a) const {
  const auto& W = diagonal[a];
  return contact_law::larger_eigenvalue(W(0, 0), (W(0, 1) + W(1, 0)) / 2, W(1, 1));
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
    const Eigen::Vector2d fresh = solved_coupled(diagonal[a], free, mu[a], old);
    for (int c = 0; c < 2; ++c) {
      state[2 * a + c] = r[2 * a + c] = fresh[c];
      step[2 * a + c] = fresh[c] - old[c];
    }
    sum += (fresh - old).squaredNorm();
  }
  return sum;
}

}  // namespace drumlin::particles
