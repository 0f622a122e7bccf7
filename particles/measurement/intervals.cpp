#include "particles/measurement/intervals.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "coupling/exchange/student.hpp"

namespace drumlin {

std::size_t batch_of(std::size_t index, std::size_t count, std::size_t batches) {
  return index * batches / count;
}

double interval_factor(std::size_t batches) {
  return student_quantile_99(std::max(1, static_cast<int>(batches / 2) - 1));
}

double jackknife_ci99(std::span<const double> leave_one_out) {
  const std::size_t count = leave_one_out.size();
  if (count < 2) return std::numeric_limits<double>::quiet_NaN();
  double mean = 0;
  for (double value : leave_one_out) mean += value / static_cast<double>(count);
  double squares = 0, neighbours = 0;
  for (std::size_t b = 0; b < count; ++b) {
    squares += (leave_one_out[b] - mean) * (leave_one_out[b] - mean);
    if (b > 0) neighbours += (leave_one_out[b] - mean) * (leave_one_out[b - 1] - mean);
  }
  if (!std::isfinite(squares)) return std::numeric_limits<double>::quiet_NaN();
  const double share = static_cast<double>(count - 1) / static_cast<double>(count);
  return interval_factor(count) * std::sqrt(share * (squares + 2 * std::max(0.0, neighbours)));
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

}  // namespace drumlin
