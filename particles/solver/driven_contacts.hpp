#pragma once
// Contacts of walls that contacts push, and of a cell under pressure, in a solve in strips: a wall, or the
// cell, is a body of many contacts, so that they are swept one after the other, on one thread, after the
// strips.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "particles/contact/problems.hpp"
#include "particles/contact/residual.hpp"
#include "particles/solver/sweep_kernels.hpp"

namespace drumlin::particles {

/// What the sweep of one of them needs, in double precision whatever that of the strips.
template <class Law>
struct DrivenContact {
  static constexpr int dim = Law::unknowns;
  int contact = 0;                       ///< of the problem
  std::int32_t i = 0, j = 0, rates = 0;  ///< records of its bodies, and of the cell's rates, if there is one
  LocalBlock<dim> W;
  contact_law::Coefficients<double, Law> mu{};
  ContactNumbers<dim> q{}, r{}, before{}, kept{};
};

/// Gives the bodies the impulses to start from.
template <class Delassus, class T, class Law>
void load(const Delassus& W, std::span<const DrivenContact<Law>> contacts, BodyRecord<T>* records) {
  for (const auto& c : contacts) W.push(c.contact, c.r, records[c.i], records[c.j], records + c.rates);
}

/// u = W r + q of a contact.
template <class Delassus, class T, class Law>
ContactNumbers<Law::unknowns> velocity(const Delassus& W, const DrivenContact<Law>& c,
                                       const BodyRecord<T>* records) {
  auto u = W.relative_velocity(c.contact, records[c.i], records[c.j], records + c.rates);
  for (int e = 0; e < Law::unknowns; ++e) u[e] += c.q[e];
  return u;
}

/// One Gauss-Seidel sweep, as SweepKernels::sweep does.
template <class Delassus, class T, class Law>
double sweep(const Delassus& W, std::span<DrivenContact<Law>> contacts, BodyRecord<T>* records, T beta,
             bool accelerated) {
  double squares = 0;
  for (auto& c : contacts) {
    auto start = c.r;
    if (accelerated)
      for (int e = 0; e < Law::unknowns; ++e) start[e] += static_cast<double>(beta) * (c.r[e] - c.before[e]);
    c.before = c.r;
    c.r = solved(Law{}, c.W, c.mu, velocity(W, c, records), start);
    auto step = c.r;
    for (int e = 0; e < Law::unknowns; ++e) {
      step[e] -= start[e];
      squares += step[e] * step[e];
    }
    W.push(c.contact, step, records[c.i], records[c.j], records + c.rates);
  }
  return squares;
}

/// Their residual as they stand.
template <class Delassus, class T, class Law>
ResidualEstimate residual(const Delassus& W, std::span<const DrivenContact<Law>> contacts,
                          const BodyRecord<T>* records) {
  ResidualEstimate estimate;
  for (const auto& c : contacts) {
    const auto u = velocity(W, c, records);
    const double lambda = largest_eigenvalue<Law::unknowns>(c.W.matrix);
    estimate.squares += squared_error<Law>(lambda, c.mu.data(), c.r.data(), u.data());
    estimate.complementarity_violation += c.r[0] * std::max(0.0, -u[0]);
    estimate.lowest_u_n = std::min(estimate.lowest_u_n, u[0]);
  }
  return estimate;
}

}  // namespace drumlin::particles
