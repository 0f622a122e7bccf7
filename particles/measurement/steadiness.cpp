#include "particles/measurement/steadiness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {

// A drift counts when it is larger than its interval and than what would matter to a reader.
constexpr double energy_that_matters = 0.1;  // of the mean
constexpr double slope_that_matters = 0.5;   // deg
constexpr double energy_too_vague = 0.5;     // an interval wider than this hides any change
constexpr double least_turns = 0.99;         // snapshots end one interval before the turn does
constexpr std::size_t least_snapshots = 20;

double mean_of(std::span<const double> values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double standard_deviation(std::span<const double> values) {
  const double mean = mean_of(values);
  double squares = 0;
  for (double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

Drift drift_of(std::span<const double> values, std::size_t batches) {
  if (values.size() < 4) return {};
  const auto first = values.first(values.size() / 2), second = values.subspan(values.size() / 2);
  return {mean_of(second) - mean_of(first),
          std::hypot(mean_ci99(first, std::max<std::size_t>(2, batches / 2)),
                     mean_ci99(second, std::max<std::size_t>(2, batches / 2)))};
}

bool counts(const Drift& drift, double matters) {
  return std::abs(drift.value) > matters && std::abs(drift.value) > drift.ci99;
}

}  // namespace

Steadiness steadiness(const TimeSeries& series, double rotation, std::size_t batches) {
  Steadiness result;
  const std::size_t count = series.time.size();
  const auto object = [&](const std::string& sentence) {
    result.steady = false;
    result.reasons.push_back(sentence);
  };
  if (count < least_snapshots) object(fmt::format("{} snapshots are fewer than {}", count, least_snapshots));
  if (rotation != 0 && count > 1) {
    const double turn = 2 * std::numbers::pi / std::abs(rotation);
    const double snapshots = static_cast<double>(count);
    result.turns = (series.time.back() - series.time.front()) * snapshots / (snapshots - 1) / turn;
    result.turns_before = std::abs(series.wall_angle.front()) / (2 * std::numbers::pi);
    if (result.turns < least_turns)
      object(fmt::format("{:.2f} turns were measured, less than one", result.turns));
    if (result.turns_before < least_turns)
      object(fmt::format("{:.2f} turns before the first snapshot are less than one", result.turns_before));
  }
  if (const double mean = mean_of(series.kinetic_energy); mean > 0) {
    result.energy = drift_of(series.kinetic_energy, batches);
    result.energy.value /= mean;
    result.energy.ci99 /= mean;
    result.energy_std = standard_deviation(series.kinetic_energy) / mean;
    if (counts(result.energy, energy_that_matters))
      object(fmt::format("the kinetic energy changes by {:.0f} +- {:.0f} % from the first half to the second",
                         100 * result.energy.value, 100 * result.energy.ci99));
    if (result.energy.ci99 > energy_too_vague)
      object(fmt::format("the kinetic energy fluctuates too much to tell: it changes by {:.0f} +- {:.0f} %",
                         100 * result.energy.value, 100 * result.energy.ci99));
  }
  if (!series.mass_angle.empty()) {
    std::vector<double> degrees;
    for (double angle : series.mass_angle) degrees.push_back(angle * 180 / std::numbers::pi);
    result.slope_deg = drift_of(degrees, batches);
    result.slope_std_deg = standard_deviation(degrees);
    if (counts(result.slope_deg, slope_that_matters))
      object(fmt::format("the slope changes by {:.2f} +- {:.2f} deg from the first half to the second",
                         result.slope_deg.value, result.slope_deg.ci99));
  }
  return result;
}

}  // namespace drumlin::particles
