#include "tests/hardcases/particles/trends.hpp"

#include <cmath>
#include <numeric>
#include <vector>

#include "coupling/core/statistics/straight_line.hpp"

namespace drumlin {

Trend trend_of(std::span<const double> values) {
  constexpr int batches = 18;
  const std::size_t length = values.size() / batches;
  values = values.last(length * batches);
  std::vector<double> means;
  for (int b = 0; b < batches; ++b) {
    double sum = 0;
    for (const double value : values.subspan(b * length, length)) sum += value;
    means.push_back(sum / static_cast<double>(length));
  }
  std::vector<double> batch(batches);
  std::iota(batch.begin(), batch.end(), 0.0);
  const auto line = statistics::fit_line(batch, means);
  const double per_entry = 1 / static_cast<double>(length);
  return {line->slope * per_entry, std::sqrt(line->reduced_chi_squared() * line->var_slope) * per_entry};
}

}  // namespace drumlin
