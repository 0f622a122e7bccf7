#pragma once
// Plain sweeps of contacts of steep friction, which begin again where they get nowhere.
#include <algorithm>
#include <vector>

#include "particles/solver/stopping_rule.hpp"

namespace drumlin::particles {

/// Sweeps of steep contacts may swing for ever from one start and not from another: a quarter of the rule's
/// sweeps goes on from the impulses r as they stand, the rest begins from none. sweep(rule) moves r and
/// reports; residual() is of r. Keeps the better impulses.
template <class Sweep, class Residual>
SolveReport from_two_starts(const StoppingRule& rule, std::vector<double>& r, Sweep sweep,
                            Residual residual) {
  StoppingRule own = rule;
  own.max_sweeps = std::max(rule.max_sweeps / 4, 1);
  const SolveReport first = sweep(own);
  if (first.status != Status::out_of_sweeps || first.sweeps >= rule.max_sweeps) return first;
  const std::vector<double> reached = r;
  std::fill(r.begin(), r.end(), 0.0);
  SolveReport both = together(first, sweep(remaining(rule, first)));
  if (both.status != Status::converged && !(both.residual.rms <= first.residual.rms)) {
    r = reached;
    both.residual = residual();
  }
  return both;
}

}  // namespace drumlin::particles
