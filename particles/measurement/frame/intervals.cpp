#include "particles/measurement/frame/intervals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/resampling.hpp"

namespace drumlin::particles {

std::size_t batch_of(std::size_t index, std::size_t count, std::size_t batches) {
  return index * batches / count;
}

double interval_factor(std::size_t batches) {
  static const auto first = [] {  // maps ask for one at each node
    std::array<double, 64> table{};
    for (std::size_t f = 1; f < table.size(); ++f)
      table[f] = statistics::student_quantile_99(static_cast<int>(f));
    return table;
  }();
  const std::size_t freedom = std::max<std::size_t>(2, batches / 2) - 1;
  return freedom < first.size() ? first[freedom] : statistics::student_quantile_99(static_cast<int>(freedom));
}

double jackknife_ci99(std::span<const double> leave_one_out) {
  if (leave_one_out.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  return interval_factor(leave_one_out.size()) * std::sqrt(statistics::jackknife_variance(leave_one_out));
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double mean_ci99(std::span<const double> series, std::size_t batches) {
  batches = std::min(batches, series.size());
  if (batches < 2) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> sum(batches, 0.0), count(batches, 0.0);
  double total = 0;
  for (std::size_t i = 0; i < series.size(); ++i) {
    const std::size_t b = batch_of(i, series.size(), batches);
    sum[b] += series[i];
    count[b] += 1;
    total += series[i];
  }
  std::vector<double> leave_one_out(batches);
  for (std::size_t b = 0; b < batches; ++b)
    leave_one_out[b] = (total - sum[b]) / (static_cast<double>(series.size()) - count[b]);
  return jackknife_ci99(leave_one_out);
}

}  // namespace drumlin::particles
