#include "particles/stepping/position_projection.hpp"

#include <algorithm>

namespace drumlin {

void project_positions(Bodies& bodies, std::span<const ClosePair> pairs, int sweeps, std::vector<double>& scratch) {
  const std::size_t count = bodies.count();
  scratch.assign(2 * count + pairs.size(), 0.0);
  double* d_x = scratch.data();
  double* d_z = d_x + count;
  double* lambda = d_z + count;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t a = 0; a < pairs.size(); ++a) {
      const ClosePair& p = pairs[a];
      const double m_i = bodies.inverse_mass[p.i], m_j = p.j >= 0 ? bodies.inverse_mass[p.j] : 0;
      double gap = p.gap + p.n_x * d_x[p.i] + p.n_z * d_z[p.i];
      if (p.j >= 0) gap -= p.n_x * d_x[p.j] + p.n_z * d_z[p.j];
      const double fresh = std::max(0.0, lambda[a] - gap / (m_i + m_j));
      const double change = fresh - lambda[a];
      if (change == 0) continue;
      lambda[a] = fresh;
      d_x[p.i] += m_i * change * p.n_x, d_z[p.i] += m_i * change * p.n_z;
      if (p.j >= 0) d_x[p.j] -= m_j * change * p.n_x, d_z[p.j] -= m_j * change * p.n_z;
    }
  for (std::size_t b = 0; b < count; ++b) bodies.x[b] += d_x[b], bodies.z[b] += d_z[b];
}

}  // namespace drumlin
