#include "particles/lab/body_system.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::particles {

template <int dim, bool with_spin>
BodySystem<dim, with_spin>::BodySystem(const Delassus& W) : lu_(pattern_of(W)) {
  if (W.coupled())
    throw InputError("the reference solver knows neither walls that contacts push nor cells under pressure");
  set_rows(W);
}

/// Also finds where the blocks of each contact stand in it.
template <int dim, bool with_spin>
SparsePattern BodySystem<dim, with_spin>::pattern_of(const Delassus& W) {
  std::vector<int> place(W.inverse_mass.size(), -1);
  int bodies = 0;
  for (std::size_t b = 0; b < place.size(); ++b)
    if (W.inverse_mass[b] > 0) place[b] = bodies++;
  std::vector<std::vector<int>> rows(bodies);  // of blocks in the columns of each body
  for (int b = 0; b < bodies; ++b) rows[b].push_back(b);
  for (int a = 0; a < W.contacts(); ++a) {
    const int i = place[W.i[a]], j = place[W.j[a]];
    ends_.push_back({i < 0 ? -1 : numbers * i, j < 0 ? -1 : numbers * j});
    if (i >= 0 && j >= 0) rows[i].push_back(j), rows[j].push_back(i);
  }
  SparsePattern pattern;
  pattern.column_start.push_back(0);
  for (auto& column : rows) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
    for (int c = 0; c < numbers; ++c) {
      for (const int b : column)
        for (int k = 0; k < numbers; ++k) pattern.row.push_back(numbers * b + k);
      pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
    }
  }
  for (const auto& ends : ends_) {
    auto& blocks = blocks_.emplace_back();
    for (int k = 0; k < 4; ++k) {
      const int I = ends[k / 2], J = ends[k % 2];
      if (I < 0 || J < 0) continue;
      const auto& column = rows[J / numbers];
      const auto found = std::lower_bound(column.begin(), column.end(), I / numbers);
      blocks[k].first = pattern.column_start[J] + numbers * static_cast<int>(found - column.begin());
      blocks[k].stride = numbers * static_cast<int>(column.size());
    }
  }
  return pattern;
}

template <int dim, bool with_spin>
void BodySystem<dim, with_spin>::set_rows(const Delassus& W) {
  for (int a = 0; a < W.contacts(); ++a) {
    Row n{}, t{};
    for (int side = 0; side < 2; ++side) {
      const double root = std::sqrt(W.inverse_mass[side == 0 ? W.i[a] : W.j[a]]);
      const double sign = side == 0 ? root : -root;
      n[numbers * side] = sign * W.n_x[a], n[numbers * side + 1] = sign * W.n_z[a];
      t[numbers * side] = sign * W.n_z[a], t[numbers * side + 1] = -sign * W.n_x[a];
      if constexpr (with_spin) t[numbers * side + 2] = -std::sqrt(2.0) * root;  // J / r^2 = m / 2
    }
    normal_.push_back(n);
    tangent_.push_back(t);
  }
}

template <int dim, bool with_spin>
std::vector<double> BodySystem<dim, with_spin>::momentum(std::span<const double> r) const {
  std::vector<double> x(size(), 0.0);
  for (int a = 0; a < contacts(); ++a)
    for (int k = 0; k < 2 * numbers; ++k) {
      const int end = ends_[a][k / numbers];
      if (end < 0) continue;
      double part = normal_[a][k] * r[dim * a];
      if constexpr (dim == 2) part += tangent_[a][k] * r[2 * a + 1];
      x[end + k % numbers] += part;
    }
  return x;
}

template <int dim, bool with_spin>
std::vector<double> BodySystem<dim, with_spin>::velocities(std::span<const double> x) const {
  std::vector<double> u(static_cast<std::size_t>(dim) * contacts(), 0.0);
  for (int a = 0; a < contacts(); ++a)
    for (int k = 0; k < 2 * numbers; ++k) {
      const int end = ends_[a][k / numbers];
      if (end < 0) continue;
      u[dim * a] += normal_[a][k] * x[end + k % numbers];
      if constexpr (dim == 2) u[2 * a + 1] += tangent_[a][k] * x[end + k % numbers];
    }
  return u;
}

/// Entries of contacts that do not answer are kept as zeros so that the pattern stays.
template <int dim, bool with_spin>
bool BodySystem<dim, with_spin>::factorise(std::span<const ContactResponse> D) {
  const SparsePattern& pattern = lu_.pattern();
  std::vector<double> values(pattern.row.size(), 0.0);
  for (int column = 0; column < pattern.size(); ++column) {
    const auto first = pattern.row.begin() + pattern.column_start[column];
    const auto last = pattern.row.begin() + pattern.column_start[column + 1];
    values[std::lower_bound(first, last, column) - pattern.row.begin()] = 1;
  }
  for (int a = 0; a < contacts(); ++a) {
    const Row &n = normal_[a], &t = tangent_[a];
    for (int side = 0; side < 4; ++side) {
      const Block& block = blocks_[a][side];
      if (block.first < 0) continue;
      const int I = numbers * (side / 2), J = numbers * (side % 2);
      for (int c = 0; c < numbers; ++c) {
        const double along_n = D[a].nn * n[J + c], along_t = D[a].tn * n[J + c] + D[a].tt * t[J + c];
        for (int k = 0; k < numbers; ++k)
          values[block.first + c * block.stride + k] += n[I + k] * along_n + t[I + k] * along_t;
      }
    }
  }
  return lu_.factorise(std::move(values));
}

template <int dim, bool with_spin>
std::vector<double> BodySystem<dim, with_spin>::solution(std::span<const double> b) const {
  std::vector<double> x(b.size());
  lu_.solve(b, x);
  return x;
}

template class BodySystem<1, false>;
template class BodySystem<2, false>;
template class BodySystem<2, true>;

}  // namespace drumlin::particles
