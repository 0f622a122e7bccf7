#include "particles/lab/block_delassus.hpp"

#include <algorithm>

#include "particles/contact_law/coulomb_coupled.hpp"

namespace drumlin::particles {

ContactNumbers<2> BlockDelassus::relative_velocity(const State& state, int a) const {
  Eigen::Vector2d u = Eigen::Vector2d::Zero();
  for (int k = row_start[a]; k < row_start[a + 1]; ++k)
    u.noalias() += block[k] * Eigen::Map<const Eigen::Vector2d>(&state[2 * column[k]]);
  return {u[0], u[1]};
}

double BlockDelassus::largest_eigenvalue(int a) const {
  const auto& W = diagonal[a];
  return contact_law::larger_eigenvalue(W(0, 0), (W(0, 1) + W(1, 0)) / 2, W(1, 1));
}

void BlockDelassus::velocities(std::span<const double> r, std::span<const double> q, State& scratch,
                               std::vector<double>& u) const {
  load(scratch, r);
  u.resize(q.size());
  for (int a = 0; a < contacts(); ++a) {
    const auto own = relative_velocity(scratch, a);
    for (int e = 0; e < 2; ++e) u[2 * a + e] = q[2 * a + e] + own[e];
  }
}

ContactNumbers<2> BlockDelassus::solved(Coulomb, int a, const contact_law::Coefficients<double, Coulomb>& mu,
                                        const ContactNumbers<2>& u, const ContactNumbers<2>& r) const {
  const Eigen::Vector2d old(r[0], r[1]);
  const Eigen::Vector2d fresh =
      solved_coupled(diagonal[a], Eigen::Vector2d(u[0], u[1]) - diagonal[a] * old, mu[0], old);
  return {fresh[0], fresh[1]};
}

}  // namespace drumlin::particles
