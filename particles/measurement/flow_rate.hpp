#pragma once
// How many grains leave per unit of time, from the times at which they left.
#include <optional>
#include <span>

namespace drumlin::particles {

/// Rate of a flow of grains, per unit of time, with the half width of its 99 % interval.
struct FlowRate {
  double rate = 0, ci99 = 0;
  double from = 0, to = 0;  ///< times between which it was taken
};
/// From the times at which grains went out: between the first and the last tenth of them, over 20 batches of
/// that time (mean_ci99). None from fewer than 100 grains.
std::optional<FlowRate> flow_rate(std::span<const double> times);

}  // namespace drumlin::particles
