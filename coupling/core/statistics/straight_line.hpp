#pragma once
// Least squares of a straight line, with the covariance of its coefficients.
#include <cstddef>
#include <optional>
#include <span>

namespace drumlin::statistics {

/// y = intercept + slope x. The covariance is that which follows from the variances given to the fit (1 each,
/// if none were): where they are known only up to a common factor, it is to be multiplied by
/// reduced_chi_squared().
struct StraightLine {
  double intercept = 0;
  double slope = 0;
  double var_intercept = 0;
  double covariance = 0;  ///< of intercept and slope
  double var_slope = 0;
  double chi_squared = 0;      ///< sum (y - intercept - slope x)^2/variance
  std::size_t points = 0;      ///< that entered
  int degrees_of_freedom = 0;  ///< points less coefficients

  /// NaN without degrees of freedom.
  double reduced_chi_squared() const;
};

/// What is known of the variances that a fit was given.
enum class Variances {
  known,     ///< the errors are those, whatever the scatter about the line
  relative,  ///< up to a common factor, which the scatter has to give
  stated,    ///< the errors are those or, where the points scatter more, larger by a common factor
};

/// Half width of the 99 % interval of a coefficient per root of its variance in `line`: normal quantile if
/// known; Student's t times sqrt(reduced_chi_squared()) if relative; the larger of both if told
/// (quantile_99_of_told_errors). NaN for relative variances without degrees of freedom.
double interval_factor_99(const StraightLine& line, Variances variances);

/// Every point alike. Needs two different x (nothing otherwise).
std::optional<StraightLine> fit_line(std::span<const double> x, std::span<const double> y);

/// Weights 1/variance, as many variances as points, > 0. Needs two different x (nothing otherwise).
std::optional<StraightLine> fit_line(std::span<const double> x, std::span<const double> y,
                                     std::span<const double> variance);

}  // namespace drumlin::statistics
