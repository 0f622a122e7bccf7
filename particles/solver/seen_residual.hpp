#pragma once
// What a solver in blocks sees of its residual on the way, at about the price of a sweep.
#include <algorithm>

#include "particles/solver/stopping_rule.hpp"

namespace drumlin::particles {

/// Over contacts as impulses and bodies stand, in the precision of the sweeps.
struct SeenResidual {
  double squares = 0;      ///< sum of the squares of the residuals e_a (docs/conventions.md)
  double let_through = 0;  ///< sum of r_n max(-u_n, 0)
  double lowest_u_n = 0;   ///< at most 0

  void add(const SeenResidual& more) {
    squares += more.squares;
    let_through += more.let_through;
    lowest_u_n = std::min(lowest_u_n, more.lowest_u_n);
  }
};

// What a solver sees and the residual in double precision differ by rounding, a thousandth where it was
// measured: beyond this, in parts of a limit, nobody needs to ask for the latter.
inline constexpr double surely_beyond = 1.02;

/// Whether a contact closes further in a step than the rule allows, and not by rounding.
inline bool closes_too_far(const SeenResidual& seen, double time_step, const StoppingRule& rule) {
  return -seen.lowest_u_n * time_step > surely_beyond * rule.penetration;
}
/// Whether bodies sink faster than the rule allows, and not by rounding; `impulses`: the sum of theirs.
inline bool sinks_too_fast(const SeenResidual& seen, double impulses, double time_step,
                           const StoppingRule& rule) {
  return time_step * seen.let_through > surely_beyond * rule.sinking * impulses;
}

}  // namespace drumlin::particles
