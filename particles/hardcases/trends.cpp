#include "particles/hardcases/trends.hpp"

#include <cmath>
#include <vector>

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
  const double middle = (batches - 1) / 2.0;
  double s_tt = 0, s_ty = 0, mean = 0;
  for (int b = 0; b < batches; ++b) mean += means[b] / batches;
  for (int b = 0; b < batches; ++b)
    s_tt += (b - middle) * (b - middle), s_ty += (b - middle) * (means[b] - mean);
  const double slope = s_ty / s_tt;
  double squares = 0;
  for (int b = 0; b < batches; ++b) squares += std::pow(means[b] - mean - slope * (b - middle), 2);
  const double per_entry = 1 / static_cast<double>(length);
  return {slope * per_entry, std::sqrt(squares / (batches - 2) / s_tt) * per_entry};
}

}  // namespace drumlin
