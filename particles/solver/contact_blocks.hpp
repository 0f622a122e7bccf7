#pragma once
// Contacts into the blocks of the kernels, and impulses out of them.
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/contact_law/laws.hpp"
#include "particles/solver/sweep_kernels.hpp"

namespace drumlin::particles {

/// Position k of a block becomes contact c of a problem, between the records i and j, with the impulses r of
/// the problem; with c = -1 a contact between these records that does nothing.
template <class T, class Law, class Problem>
void set_place(const Problem& problem, std::int32_t c, std::int32_t i, std::int32_t j,
               std::span<const double> r, ContactBlock<T, Law>& block, std::size_t k) {
  constexpr int dim = Law::unknowns, coefficients = Law::coefficients;
  const auto& W = problem.W;
  const auto number = [c](double value) { return c >= 0 ? static_cast<T>(value) : T(0); };
  const std::int32_t a = std::max(c, 0);
  block.i[k] = static_cast<std::uint32_t>(i * sizeof(BodyRecord<T>));
  block.j[k] = static_cast<std::uint32_t>(j * sizeof(BodyRecord<T>));
  block.n_x[k] = number(W.n_x[a]), block.n_z[k] = number(W.n_z[a]);
  block.inverse_W_nn[k] = c >= 0 ? static_cast<T>(W.inverse_W_nn[a]) : T(1);
  for (int e = 0; e < dim; ++e) {
    block.q[e][k] = number(problem.q[dim * a + e]);
    block.r[e][k] = block.before[e][k] = number(r[dim * a + e]);
  }
  if constexpr (coefficients > 0)
    for (int e = 0; e < coefficients; ++e) block.mu[e][k] = number(problem.mu[coefficients * a + e]);
  if constexpr (dim == 3) {
    const auto inverse = W.block(a).inverse;
    block.radius_ratio[k] = number(W.radius_ratio[a]);
    block.inverse_W_rr[k] = number(inverse.rr), block.inverse_W_tt[k] = number(inverse.tt_reduced);
  }
}

/// Impulses of contact c to the array r of a problem, held to their cone, which single precision oversteps by
/// a rounding.
template <class Problem, std::size_t dim>
void hold_to_cone(const Problem& problem, std::int32_t c, const std::array<double, dim>& impulses,
                  std::vector<double>& r) {
  const auto held = contact_law::bounded(typename Problem::Law{}, problem.coefficients(c), impulses);
  std::copy(held.begin(), held.end(), r.begin() + dim * c);
}

/// The impulses at position k of a block.
template <class T, std::size_t dim>
std::array<double, dim> impulses_at(const std::array<std::array<T, 8>, dim>& block, std::size_t k) {
  std::array<double, dim> own;
  for (std::size_t e = 0; e < dim; ++e) own[e] = static_cast<double>(block[e][k]);
  return own;
}

}  // namespace drumlin::particles
