#pragma once
// When a solve in blocks ends: by estimates of its residual on the way, and by the residual itself.
#include <cmath>
#include <limits>

#include "particles/solver/residual_estimate.hpp"
#include "particles/solver/stopping_rule.hpp"

namespace drumlin::particles {

/// What SolveEnd asks of the blocks that are swept: estimate() of their residual, summed_impulses() of their
/// bodies, keep() to keep their impulses, and residual(kept), which unpacks these impulses or those kept.
template <class Estimate, class SummedImpulses, class Keep, class Residual>
struct SweptBlocks {
  Estimate estimate;
  SummedImpulses summed_impulses;
  Keep keep;
  Residual residual;
};
template <class... Of>  // compilers that deduce it for aggregates need no guide
SweptBlocks(Of...)->SweptBlocks<Of...>;

/// Ends one solve in blocks. While the steps of the sweeps say that the residual is far, three of four
/// estimates are left out; where an estimate is small enough the residual itself decides. In single precision
/// a solve also ends, out of sweeps before they are, when the estimate (of large problems, of all that the
/// rule asks for) stands still or the residual is more than three times of it. Impulses that miss the rule
/// are the best by the estimate.
class SolveEnd {
 public:
  struct Kind {
    double time_step = 1, rounding = 0;
    double residual_scale = 1;  ///< turns squares of an estimate into the square of the relative residual
    SweepExtrapolation how = SweepExtrapolation::none;
    bool single = false;          ///< sweeps are in single precision
    bool steep = false;           ///< they are accelerated, and friction is steep
    bool limits_sinking = false;  ///< the rule limits it, and the blocks know it
  };
  SolveEnd(const StoppingRule& rule, const Kind& kind)
      : rule_(rule), kind_(kind), test_(rule), progress_(kind.how) {}

  /// Sweeps after which the next round ends.
  int next_round(int sweeps) const {
    do ++sweeps;
    while (!test_.due(sweeps));
    return sweeps;
  }
  /// Whether a round that ends after so many sweeps is the last one in any case.
  bool last(int sweeps) const { return sweeps >= rule_.max_sweeps || test_.out_of_time(); }
  /// Whether the residual is to be estimated after sweeps with steps of this sum of squares.
  bool estimate_due(double steps, bool last) const {
    constexpr int most_left_out = 3;
    return last || steps <= threshold_ || left_out_ >= most_left_out;
  }
  void leave_out() { ++left_out_; }
  /// After so many sweeps, where an estimate is due: whether the solve ends, with report().
  template <class Blocks>
  bool ends(const Blocks& blocks, int sweeps, double steps, bool finite, bool last);
  const SolveReport& report() const { return test_.report(); }

 private:
  StoppingRule rule_;
  Kind kind_;
  StoppingTest test_;
  SolveProgress progress_;
  double threshold_ = std::numeric_limits<double>::infinity();  // of steps: above it the residual is far
  double best_ = std::numeric_limits<double>::infinity();
  int left_out_ = 0;  // estimates, in turn
};

template <class Blocks>
bool SolveEnd::ends(const Blocks& blocks, int sweeps, double steps, bool finite, bool last) {
  constexpr double tolerance_factor = 2;  // an estimate is due where this many tolerances are expected
  left_out_ = 0;
  const ResidualEstimate sums = blocks.estimate();
  const double estimate = std::sqrt(sums.squares * kind_.residual_scale);
  const double fall = tolerance_factor * rule_.tolerance / estimate;  // residuals fall about as steps do
  threshold_ = steps * fall * fall;
  LimitRatios ratios = limit_ratios(sums, estimate, kind_.time_step, rule_);
  if (kind_.limits_sinking && (progress_.exact() || !progress_.surely_missed(ratios)))
    ratios.sinking = sums.lowest_u_n >= -kind_.rounding
                         ? 0
                         : sinking_of(sums, blocks.summed_impulses(), kind_.time_step, rule_);
  progress_.record(ratios, sweeps);
  // Rounding of single precision hides the progress, or momentum keeps steep contacts swinging.
  constexpr int patience = 200, patience_of_steep = 100;  // sweeps
  const bool stuck =
      (kind_.single || kind_.steep) && progress_.idle(sweeps) >= (kind_.steep ? patience_of_steep : patience);
  const double missed = progress_.counted(ratios);
  if (missed < best_) best_ = missed, blocks.keep();
  if (!last && !stuck && progress_.surely_missed(ratios)) return false;
  const bool ended = test_.ends(sweeps, blocks.residual(false), finite);
  const bool hidden = kind_.single && test_.report().residual.rms > 3 * estimate;
  if (!ended && !stuck && !hidden) {
    progress_.compare(ratios, test_.report().residual.sinking / rule_.sinking);
    return false;
  }
  if (best_ < missed && test_.report().status != Status::converged) test_.replace(blocks.residual(true));
  return true;
}

}  // namespace drumlin::particles
