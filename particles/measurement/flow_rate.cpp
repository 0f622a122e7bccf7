#include "particles/measurement/flow_rate.hpp"

#include <algorithm>
#include <vector>

#include "coupling/core/statistics/samples.hpp"
#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {
constexpr std::size_t time_batches = 20, fewest_taken = 100;
}

std::optional<FlowRate> flow_rate(std::span<const double> times) {
  if (times.size() < fewest_taken) return std::nullopt;
  const double from = times[times.size() / 10], to = times[times.size() - 1 - times.size() / 10];
  if (!(to > from)) return std::nullopt;
  std::vector<double> rates(time_batches, 0.0);
  const double length = (to - from) / static_cast<double>(time_batches);
  for (const double time : times)
    if (time >= from && time < to)
      rates[std::min(time_batches - 1, static_cast<std::size_t>((time - from) / length))] += 1 / length;
  return FlowRate{statistics::mean(rates), mean_ci99(rates, time_batches), from, to};
}

}  // namespace drumlin::particles
