#include "coupling/core/statistics/samples.hpp"

#include <cassert>
#include <limits>

namespace drumlin::statistics {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double mean(std::span<const double> values) {
  if (values.empty()) return nan;
  const auto count = static_cast<double>(values.size());
  double result = 0;
  for (const double value : values) result += value / count;
  return result;
}

double variance(std::span<const double> values) {
  if (values.size() < 2) return nan;
  const double middle = mean(values);
  double squares = 0;
  for (const double value : values) squares += (value - middle) * (value - middle);
  return squares / static_cast<double>(values.size() - 1);
}

WeightedMean weighted_mean(std::span<const double> values, std::span<const double> variances) {
  assert(values.size() == variances.size());
  WeightedMean result;
  double weights = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double weight = 1 / variances[i];
    weights += weight;
    result.value += weight * values[i];
  }
  result.value /= weights;
  result.variance = 1 / weights;
  return result;
}

}  // namespace drumlin::statistics
