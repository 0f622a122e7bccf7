#pragma once
// mu(I) through measured points, robustly, and what other draws of the same points would have given.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "coupling/calibration/friction_form.hpp"
#include "coupling/calibration/log_friction.hpp"

namespace drumlin::coupling {

struct RobustFriction {
  Coefficients law;
  double rms_misfit = 0;         ///< of mu, over all points alike
  double intrinsic_scatter = 0;  ///< standard deviation of mu beyond the errors of the points
  double outlier_share = 0;      ///< of the points, further off than 1.5 standard deviations
  std::size_t points = 0;
};

/// Huber's estimator: least squares whose points count less than their weight where they lie further off than
/// 1.5 standard deviations (Huber & Ronchetti, Robust Statistics, 2009, ch. 7). Variance of a point:
/// mu_error^2 + (I dmu/dI I_error/I)^2 + s^2, s found together with the law (Huber's proposal 2), zero where
/// the errors of the points explain the misfit. Steps of Gauss and Newton where the form is not linear in its
/// coefficients. Coefficients stay above least_coefficient(). Throws InputError with fewer points than
/// coefficients and one, or all at the same I.
RobustFriction fit_friction(const std::vector<FrictionPoint>& points, const FrictionForm& form);

/// The laws of `replicates` draws: from each run as many points as it has, in blocks of neighbours (4 points,
/// for points next to each other move together), with replacement (Kuensch, Ann. Stat. 17 (1989) 1217); of a
/// run of less than two blocks, which holds no others to draw, all points with their misfit times one number
/// that is normal with variance 1 (Wu, Ann. Stat. 14 (1986) 1261). The scatter is that of all points. Draws
/// (where all runs are so short, misfits) are widened about the law of all points, since few blocks differ by
/// less than new measurements would; a coefficient that this takes below its least value is held there. The
/// same `seed` gives the same draws. `before_each`, if there is one, is called before each: it may throw.
std::vector<Coefficients> bootstrapped(const std::vector<std::vector<FrictionPoint>>& runs,
                                       const FrictionForm& form, int replicates, std::uint64_t seed = 1,
                                       const std::function<void()>& before_each = {});

struct FrictionBand {
  double low = 0;
  double high = 0;
};

/// Quantiles that leave out half of 1 - `share` of the values at each end; one value at least.
FrictionBand range_of(std::vector<double> values, double share = 0.99);

/// Laws of several draws and what lies between them.
class BandOfDraws {
 public:
  /// One law at least.
  BandOfDraws(const FrictionForm& form, const std::vector<Coefficients>& laws);
  /// range_of() the laws at I.
  FrictionBand at(double I, double share = 0.99) const;
  /// Half width of the 99 % band, the mean of its two sides.
  double half_width_at(double I) const;

 private:
  std::vector<FormCurve> curves_;  // never empty
};

}  // namespace drumlin::coupling
