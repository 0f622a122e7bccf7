#pragma once
// Means and variances of samples. Sums run in the order of the samples.
#include <cstddef>
#include <span>

namespace drumlin::statistics {

/// sum x/n. NaN without values.
double mean(std::span<const double> values);

/// sum (x - mean)^2/(n - 1). NaN with fewer than two values.
double variance(std::span<const double> values);

/// sum x/s^2 / sum 1/s^2, the mean of least variance where the errors are independent.
struct WeightedMean {
  double value = 0;
  double variance = 0;     ///< 1 / sum 1/s^2
  double chi_squared = 0;  ///< sum (x - value)^2/s^2
};
/// `variances`: s^2 of each value, as many as values, > 0.
WeightedMean weighted_mean(std::span<const double> values, std::span<const double> variances);

/// Sums of squares and degrees of freedom of several groups that share one variance, each about a mean of its
/// own: the more groups, the better that variance is known. In units of variances that were told, it is the
/// factor by which these are too small.
class PooledVariance {
 public:
  /// A group of `count` values whose sum of squares about its mean is given. One value alone says nothing.
  void add(double sum_of_squares, std::size_t count);
  /// NaN without degrees of freedom.
  double value() const;
  int degrees_of_freedom() const { return degrees_of_freedom_; }

 private:
  double sum_of_squares_ = 0;
  int degrees_of_freedom_ = 0;
};

}  // namespace drumlin::statistics
