#pragma once
// What a solver in blocks sees of its residual on the way, at about the price of a sweep.
#include <algorithm>
#include <limits>

#include "particles/solver/momentum.hpp"
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

/// What a solve has seen of its rule, in parts of the limits: it holds where none is above 1.
struct SeenMisses {
  double residual = 0, penetration = 0;
  double sinking = 0;  ///< to be set, where the rule limits it
};
/// `relative`: the residual that was seen. A rule that tolerates none is missed by numbers that still
/// compare.
inline SeenMisses misses_of(const SeenResidual& seen, double relative, double time_step,
                            const StoppingRule& rule) {
  return {relative / std::max(rule.tolerance, 1e-100), -seen.lowest_u_n * time_step / rule.penetration, 0};
}
/// `impulses`: the sum of those of bodies.
inline double sinking_of(const SeenResidual& seen, double impulses, double time_step,
                         const StoppingRule& rule) {
  return seen.let_through == 0 ? 0 : time_step * seen.let_through / (rule.sinking * impulses);
}

/// Whether a solve still comes nearer to its rule, or rounding hides that. Where sweeps extrapolate exactly,
/// all that it misses counts: under a deep bed bodies sink too fast long after the residual is small enough,
/// by less and less but slowly, and what it sees of that is off by the same half of a hundredth from look to
/// look. Else what is seen differs by a thousandth where it was measured, and the residual alone counts.
class SeenProgress {
 public:
  explicit SeenProgress(SweepExtrapolation how) : exact_(how == SweepExtrapolation::exact) {}

  bool exact() const { return exact_; }
  /// Whether the rule is missed, and not by rounding: nobody needs to ask for the residual in double
  /// precision.
  bool surely_misses(const SeenMisses& misses) const {
    return misses.residual > 1 ||
           std::max(misses.penetration, sinking_ * misses.sinking) > (exact_ ? 1.0005 : 1.02);
  }
  /// What counts of that.
  double missed(const SeenMisses& misses) const {
    return exact_ ? std::max({misses.residual, misses.penetration, misses.sinking}) : misses.residual;
  }
  void see(const SeenMisses& misses, int sweeps) {
    const double missed = this->missed(misses);
    if (missed < (exact_ ? 0.99 : 0.9) * least_) least_ = missed, at_ = sweeps;
  }
  /// After a look at the residual in double precision, which had another sinking than was seen.
  void compare(const SeenMisses& misses, double sinking) {
    if (exact_ && misses.sinking > 0) sinking_ = std::clamp(sinking / misses.sinking, 0.98, 1.02);
  }
  /// Whether too many sweeps have gone without progress: a flow takes 10 for a tenth of its residual, a solve
  /// that starts from no impulses rests for hundreds and then goes on, so that as many are too many as it
  /// took to get there.
  bool stuck(int sweeps) const { return sweeps - at_ >= std::max(at_, exact_ ? 200 : 100); }

 private:
  bool exact_;
  double least_ = std::numeric_limits<double>::infinity();
  double sinking_ = 1;  // in double precision, in parts of what is seen
  int at_ = 0;
};

}  // namespace drumlin::particles
