#pragma once
// Converts contact problems to the block form in which they travel in files.
#include <optional>
#include <span>
#include <vector>

#include "particles/contact/problems.hpp"
#include "particles/lab/block_delassus.hpp"

namespace drumlin::particles {

/// The same contacts, q, friction and time step with W assembled; u and the residual agree to rounding.
BlockProblem block_problem(const CoulombProblem&);
BlockProblem block_problem(const CoulombSpinProblem&);

/// A frictionless contact gets mu = 0 and a tangential direction in which nothing acts: q_t = 0, W_tt = W_nn
/// on the diagonal, no coupling. The solutions are the same; rms(q) runs over twice as many entries, so that
/// the residual is sqrt(2) times as large.
BlockProblem block_problem(const FrictionlessProblem&);

/// Of any kind; none where a contact has more unknowns or couples than a file can hold (a couple, walls moved
/// by a force).
std::optional<BlockProblem> block_problem(const DiscProblem&);

/// Numbers of a problem (r, q, u) in the layout of its block form: normal, tangential.
template <class Problem>
std::vector<double> block_layout(std::span<const double> r) {
  if constexpr (Problem::dim == 2) {
    return {r.begin(), r.end()};
  } else {
    std::vector<double> wide(2 * r.size(), 0.0);
    for (std::size_t a = 0; a < r.size(); ++a) wide[2 * a] = r[a];
    return wide;
  }
}

}  // namespace drumlin::particles
