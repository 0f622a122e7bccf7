#pragma once
// Solves that go on with a second method, or from another start, where a first one was given up.
#include <algorithm>
#include <vector>

#include "particles/solver/stopping_rule.hpp"

namespace drumlin::particles {

/// The report `both` of r, or, where a first method had `reached` better ones, of these, which r becomes.
template <class Residual>
SolveReport better(const SolveReport& first, const std::vector<double>& reached, SolveReport both,
                   std::vector<double>& r, Residual residual) {
  if (both.status != Status::converged && !(both.residual.rms <= first.residual.rms)) {
    r = reached;
    both.residual = residual();
  }
  return both;
}

/// Sweeps of steep contacts may swing for ever: after every hundred of them settle(rule) goes on from the
/// impulses r. Keeps the best ones.
template <class Sweep, class Settle, class Residual>
SolveReport settle_in_turn(const StoppingRule& rule, std::vector<double>& r, Sweep sweep, Settle settle,
                           Residual residual) {
  constexpr int sweeps_in_turn = 100;
  const auto some = [&](StoppingRule own) {
    own.max_sweeps = std::min(own.max_sweeps, sweeps_in_turn);
    return sweep(own);
  };
  SolveReport now = some(rule), best = now;
  std::vector<double> reached = r;
  for (bool settled = false; now.status == Status::out_of_sweeps && now.sweeps < rule.max_sweeps;) {
    settled = !settled;
    const StoppingRule left = remaining(rule, now);
    now = together(now, settled ? settle(left) : some(left));
    if (now.residual.rms < best.residual.rms) best = now, reached = r;
  }
  return better(best, reached, now, r, residual);
}

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
  return better(first, reached, together(first, sweep(remaining(rule, first))), r, residual);
}

/// Goes on with a second method, second(rule), from where a first one has moved the impulses r, unless the
/// rule leaves nothing. Keeps the better impulses.
template <class Second, class Residual>
SolveReport go_on(const StoppingRule& rule, const SolveReport& first, std::vector<double>& r, Second second,
                  Residual residual) {
  if (first.status == Status::not_finite || first.status == Status::out_of_time ||
      first.sweeps >= rule.max_sweeps)
    return judged(rule, first);
  const std::vector<double> reached = r;
  return better(first, reached, together(first, second(remaining(rule, first))), r, residual);
}

}  // namespace drumlin::particles
