#pragma once
// Contacts of walls that contacts push, and of a cell under pressure, in a solve in strips: a wall, or the
// cell, is a body of many contacts, so that
// they are swept one after the other, on one thread, after the strips.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/contact/general_delassus.hpp"
#include "particles/contact/residual.hpp"
#include "particles/solver/sweep_kernels.hpp"

namespace drumlin::particles {

/// What the sweep of one of them needs, in double precision whatever that of the strips.
template <int dim>
struct DrivenContact {
  using Impulse = std::array<double, dim>;
  int contact = 0;            ///< of the problem
  std::int32_t i = 0, j = 0;  ///< records of the grain and of the wall; in a cell, of two grains
  std::int32_t cell = -1;     ///< record of the cell's rates; -1: none
  double n_x = 0, n_z = 0, lever = 1;
  DrivenBody driven;
  double arm_x = 0, arm_z = 0, answer_x = 0, answer_z = 0;  ///< of the cell: arm, and times inverse inertia
  LocalBlock<dim> W;
  Impulse q{}, r{}, before{}, kept{};
  contact_law::Coefficients<double, dim> mu{};
};

/// Adds impulses of a contact to the records of its grain and of its wall, which holds the wall's change of
/// velocity; or of its two grains and of the cell.
template <bool spin, class T, int dim>
void push(const DrivenContact<dim>& c, const typename DrivenContact<dim>::Impulse& r, BodyRecord<T>* bodies) {
  BodyRecord<T>&I = bodies[c.i], &J = bodies[c.j];
  double p_x = c.n_x * r[0], p_z = c.n_z * r[0];
  if constexpr (dim >= 2) p_x += c.n_z * r[1], p_z -= c.n_x * r[1];
  const double m = I.inverse_mass;
  I.x += static_cast<T>(m * p_x), I.z += static_cast<T>(m * p_z);
  if constexpr (spin && dim >= 2) I.s -= static_cast<T>(2 * m * r[1]);
  if constexpr (dim == 3) I.s += static_cast<T>(2 * m * c.lever * r[2]);
  if (c.cell >= 0) {
    const double w = J.inverse_mass;
    J.x -= static_cast<T>(w * p_x), J.z -= static_cast<T>(w * p_z);
    if constexpr (spin && dim >= 2) J.s -= static_cast<T>(2 * w * r[1]);
    if constexpr (dim == 3) J.s -= static_cast<T>(2 * w * (1 - c.lever) * r[2]);
    bodies[c.cell].x += static_cast<T>(c.answer_x * p_x);
    bodies[c.cell].z += static_cast<T>(c.answer_z * p_z);
    return;
  }
  const double along = (p_x * c.driven.e_x + p_z * c.driven.e_z) * c.driven.inverse_mass;
  J.x -= static_cast<T>(along * c.driven.e_x), J.z -= static_cast<T>(along * c.driven.e_z);
}

/// u = W r + q of a contact. A wall does not turn: its record says so.
template <bool spin, class T, int dim>
std::array<double, dim> velocity(const DrivenContact<dim>& c, const BodyRecord<T>* bodies) {
  const BodyRecord<T>&I = bodies[c.i], &J = bodies[c.j];
  double d_x = I.x - J.x, d_z = I.z - J.z;
  if (c.cell >= 0) d_x += c.arm_x * bodies[c.cell].x, d_z += c.arm_z * bodies[c.cell].z;
  auto u = c.q;
  u[0] += c.n_x * d_x + c.n_z * d_z;
  if constexpr (dim >= 2) u[1] += c.n_z * d_x - c.n_x * d_z;
  if constexpr (spin && dim >= 2) u[1] -= I.s + J.s;
  if constexpr (dim == 3) u[2] += c.lever * I.s - (1 - c.lever) * J.s;
  return u;
}

/// One Gauss-Seidel sweep, as SweepKernels::sweep does.
template <bool spin, class T, int dim>
double sweep(std::span<DrivenContact<dim>> contacts, BodyRecord<T>* bodies, T beta, bool accelerated) {
  double squares = 0;
  for (auto& c : contacts) {
    auto start = c.r;
    if (accelerated)
      for (int e = 0; e < dim; ++e) start[e] += static_cast<double>(beta) * (c.r[e] - c.before[e]);
    c.before = c.r;
    c.r = solved(c.W, c.mu, velocity<spin>(c, bodies), start);
    auto step = c.r;
    for (int e = 0; e < dim; ++e) {
      step[e] -= start[e];
      squares += step[e] * step[e];
    }
    push<spin>(c, step, bodies);
  }
  return squares;
}

/// Their residual as they stand.
template <bool spin, class T, int dim>
ResidualEstimate residual(std::span<const DrivenContact<dim>> contacts, const BodyRecord<T>* bodies) {
  ResidualEstimate estimate;
  for (const auto& c : contacts) {
    const auto u = velocity<spin>(c, bodies);
    const double lambda = largest_eigenvalue<dim>(c.W.matrix);
    estimate.squares += squared_error<dim>(lambda, c.mu.data(), c.r.data(), u.data());
    estimate.complementarity_violation += c.r[0] * std::max(0.0, -u[0]);
    estimate.lowest_u_n = std::min(estimate.lowest_u_n, u[0]);
  }
  return estimate;
}

}  // namespace drumlin::particles
