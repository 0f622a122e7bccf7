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
  double variance = 0;  ///< 1 / sum 1/s^2
};
/// `variances`: s^2 of each value, as many as values, > 0.
WeightedMean weighted_mean(std::span<const double> values, std::span<const double> variances);

}  // namespace drumlin::statistics
