#include "coupling/core/statistics/resampling.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "coupling/core/statistics/samples.hpp"

namespace drumlin::statistics {

double jackknife_variance(std::span<const double> leave_one_out) {
  const std::size_t count = leave_one_out.size();
  if (count < 2) return std::numeric_limits<double>::quiet_NaN();
  const double middle = mean(leave_one_out);
  double squares = 0, neighbours = 0;
  for (std::size_t b = 0; b < count; ++b) {
    squares += (leave_one_out[b] - middle) * (leave_one_out[b] - middle);
    if (b > 0) neighbours += (leave_one_out[b] - middle) * (leave_one_out[b - 1] - middle);
  }
  if (!std::isfinite(squares)) return std::numeric_limits<double>::quiet_NaN();
  const double share = static_cast<double>(count - 1) / static_cast<double>(count);
  return share * (squares + 2 * std::max(0.0, neighbours));
}

std::vector<std::size_t> block_draw(std::size_t count, std::size_t block_length, std::mt19937_64& random) {
  assert(count > 0 && block_length > 0);
  std::vector<std::size_t> draw;
  while (draw.size() < count) {
    const std::size_t first = random() % count;  // std's distributions differ from one library to the next
    for (std::size_t k = 0; k < block_length && draw.size() < count; ++k) draw.push_back((first + k) % count);
  }
  return draw;
}

}  // namespace drumlin::statistics
