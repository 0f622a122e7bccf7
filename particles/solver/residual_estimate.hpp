#pragma once
// The estimate of its residual that a solver in blocks makes on the way, at about the price of a sweep.
#include <algorithm>
#include <limits>

#include "particles/solver/momentum.hpp"
#include "particles/solver/stopping_rule.hpp"

namespace drumlin::particles {

/// Over contacts as impulses and bodies stand, in the precision of the sweeps.
struct ResidualEstimate {
  double squares = 0;                    ///< sum of the squares of the residuals e_a (docs/conventions.md)
  double complementarity_violation = 0;  ///< sum of r_n max(-u_n, 0)
  double lowest_u_n = 0;                 ///< at most 0

  void add(const ResidualEstimate& more) {
    squares += more.squares;
    complementarity_violation += more.complementarity_violation;
    lowest_u_n = std::min(lowest_u_n, more.lowest_u_n);
  }
};

/// What a solve misses of its rule by the estimate, in parts of the limits: the rule holds where none is
/// above 1.
struct LimitRatios {
  double residual = 0, penetration = 0;
  double sinking = 0;  ///< to be set, where the rule limits it
};
/// `relative`: the estimate, relative as the residual is. A rule that tolerates none is missed by numbers
/// that still compare.
inline LimitRatios limit_ratios(const ResidualEstimate& estimate, double relative, double time_step,
                                const StoppingRule& rule) {
  return {relative / std::max(rule.tolerance, 1e-100), -estimate.lowest_u_n * time_step / rule.penetration,
          0};
}
/// `impulses`: the sum of those of bodies.
inline double sinking_of(const ResidualEstimate& estimate, double impulses, double time_step,
                         const StoppingRule& rule) {
  return estimate.complementarity_violation == 0
             ? 0
             : time_step * estimate.complementarity_violation / (rule.sinking * impulses);
}

/// Whether a solve still comes nearer to its rule, or rounding hides that. Where sweeps extrapolate exactly,
/// all limits count: under a deep bed bodies sink too fast long after the residual is small enough, by less
/// and less but slowly, and the estimate of that is off by the same half of a hundredth from check to check.
/// Else estimates were off by a thousandth where that was measured, and the residual alone counts.
class SolveProgress {
 public:
  explicit SolveProgress(SweepExtrapolation how) : exact_(how == SweepExtrapolation::exact) {}

  bool exact() const { return exact_; }
  /// Whether the rule is missed, and not by rounding: nobody needs to ask for the residual in double
  /// precision.
  bool surely_missed(const LimitRatios& ratios) const {
    return ratios.residual > 1 ||
           std::max(ratios.penetration, sinking_ * ratios.sinking) > (exact_ ? 1.0005 : 1.02);
  }
  /// The largest of the ratios that count.
  double counted(const LimitRatios& ratios) const {
    return exact_ ? std::max({ratios.residual, ratios.penetration, ratios.sinking}) : ratios.residual;
  }
  void record(const LimitRatios& ratios, int sweeps) {
    const double missed = counted(ratios);
    if (missed < (exact_ ? 0.99 : 0.9) * least_) least_ = missed, at_ = sweeps;
  }
  /// After the residual in double precision, which had another sinking than the estimate.
  void compare(const LimitRatios& ratios, double sinking) {
    if (exact_ && ratios.sinking > 0) sinking_ = std::clamp(sinking / ratios.sinking, 0.98, 1.02);
  }
  /// Sweeps without progress; a flow takes 10 for a tenth of its residual.
  int idle(int sweeps) const { return sweeps - at_; }

 private:
  bool exact_;
  double least_ = std::numeric_limits<double>::infinity();
  double sinking_ = 1;  // in double precision, in parts of the estimate
  int at_ = 0;
};

}  // namespace drumlin::particles
