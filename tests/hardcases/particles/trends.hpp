#pragma once
// Whether a series drifts.
#include <span>

namespace drumlin {

struct Trend {
  double slope = 0;  ///< per entry
  double error = 0;  ///< its standard error
};
/// Straight line through the means of 18 consecutive batches (neighbouring entries are correlated), by least
/// squares; the standard error is that of its residuals. At least 36 entries; those that do not fill a batch
/// are left out, from the front.
Trend trend_of(std::span<const double> values);

}  // namespace drumlin
