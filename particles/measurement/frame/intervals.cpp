#include "particles/measurement/frame/intervals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
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

std::vector<SeriesSum> batch_sums(std::span<const double> series, std::size_t batches) {
  std::vector<SeriesSum> sums(std::min(batches, series.size()));
  for (std::size_t i = 0; i < series.size(); ++i)
    add_times(1, SeriesSum{series[i], 1}, sums[batch_of(i, series.size(), sums.size())]);
  return sums;
}

double mean_ci99(std::span<const double> series, std::size_t batches) {
  const auto sums = batch_sums(series, batches);
  return sums.empty() ? std::numeric_limits<double>::quiet_NaN()
                      : ci99_of(leave_one_out(sums), &SeriesSum::mean);
}

}  // namespace drumlin::particles
