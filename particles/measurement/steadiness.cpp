#include "particles/measurement/steadiness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "coupling/core/statistics/samples.hpp"
#include "coupling/core/statistics/straight_line.hpp"
#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {

// A drift counts when it is larger than its interval and than what would matter to a reader.
constexpr double energy_that_matters = 0.1;  // of the mean
constexpr double slope_that_matters = 0.5;   // deg
constexpr double energy_too_vague = 0.5;     // an interval wider than this hides any change
constexpr double trend_that_matters = 0.2;   // of ln(energy): twice what matters between the halves
constexpr double stress_that_matters = 0.1;  // of the mean
constexpr double stress_too_vague = 0.25;    // an interval wider than this hides any change
constexpr double least_turns = 0.99;         // snapshots end one interval before the turn does
constexpr std::size_t least_snapshots = 20;
constexpr const char* between_halves = " from the first half to the second";

double standard_deviation(std::span<const double> values) {
  const double mean = statistics::mean(values);
  double squares = 0;
  for (double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size()));
}

Drift drift_of(std::span<const double> values, std::size_t batches) {
  if (values.size() < 4) return {};
  const auto first = values.first(values.size() / 2), second = values.subspan(values.size() / 2);
  const std::size_t of_each = std::max<std::size_t>(2, batches / 2);
  return {statistics::mean(second) - statistics::mean(first),
          std::hypot(mean_ci99(first, of_each), mean_ci99(second, of_each))};
}

bool counts(const Drift& drift, double matters) {
  return std::abs(drift.value) > matters && std::abs(drift.value) > drift.ci99;
}

void object(Steadiness& result, const std::string& sentence) {
  result.steady = false;
  result.reasons.push_back(sentence);
}

/// What changes from the first half to the second, and by how much.
std::string change_of(const char* what, const Drift& drift) {
  return fmt::format("the {} by {:.0f} +- {:.0f} %", what, 100 * drift.value, 100 * drift.ci99);
}

/// False when the energy scatters so much that it tells nothing.
bool judge_energy(const TimeSeries& series, std::size_t batches, Steadiness& result) {
  const double mean = statistics::mean(series.kinetic_energy);
  if (!(mean > 0)) return true;
  result.energy = drift_of(series.kinetic_energy, batches);
  result.energy.value /= mean;
  result.energy.ci99 /= mean;
  result.energy_std = standard_deviation(series.kinetic_energy) / mean;
  std::vector<double> blocks;  // NaN of an energy of 0
  for (const SeriesSum& block : batch_sums(series.kinetic_energy, batches))
    blocks.push_back(block.sum > 0 ? std::log(block.mean()) : std::nan(""));
  if (std::isfinite(statistics::mean(blocks))) result.energy_trend = trend_over(blocks);
  if (counts(result.energy, energy_that_matters)) {
    object(result, change_of("kinetic energy changes", result.energy) + between_halves);
    return true;
  }
  if (const Drift& trend = result.energy_trend; counts(trend, trend_that_matters)) {
    object(result, fmt::format("the kinetic energy {} by a factor of {:.2g} ({:.2g} ... {:.2g}) over the "
                               "snapshots",
                               trend.value < 0 ? "decays" : "grows", std::exp(std::abs(trend.value)),
                               std::exp(std::abs(trend.value) - trend.ci99),
                               std::exp(std::abs(trend.value) + trend.ci99)));
    return true;
  }
  return !(result.energy.ci99 > energy_too_vague);
}

/// Whether anything flows, against the drum where there is one.
bool judge_path(const TimeSeries& series, Steadiness& result) {
  if (series.speed.size() < 2) return true;
  const double time = series.time.back() - series.time.front(), path = statistics::mean(series.speed) * time;
  result.flows = !(path < least_path);
  if (!result.flows)
    object(result, fmt::format("nothing flows: in {:.3g} sqrt(d/g) a grain moves by {:.1g} d", time, path));
  return result.flows;
}

/// The change of a quantity over its mean; NaN where the mean is not known to half its size.
Drift relative_drift(std::span<const double> values, std::size_t batches) {
  const double mean = values.empty() ? 0 : statistics::mean(values);
  if (!(std::abs(mean) > 2 * mean_ci99(values, batches))) return {};
  const Drift drift = drift_of(values, batches);
  return {drift.value / mean, drift.ci99 / std::abs(mean)};
}

/// Stress and shear rate of a packing without a drum: objects to a change that counts. True when they tell
/// that there is none: the pressure and one of the others are known well enough.
bool judge_packing(const TimeSeries& series, std::size_t batches, Steadiness& result) {
  int known = 0;
  const auto judge = [&](const char* name, const std::vector<double>& values, Drift& drift) {
    drift = relative_drift(values, batches);
    if (counts(drift, stress_that_matters)) object(result, change_of(name, drift) + between_halves);
    known += drift.ci99 <= stress_too_vague ? 1 : 0;
  };
  judge("pressure changes", series.pressure, result.pressure);
  const bool pressure_known = known > 0;
  judge("shear stress changes", series.shear_stress, result.shear_stress);
  judge("shear rate changes", series.shear_rate, result.shear_rate);
  return pressure_known && known > 1;
}

}  // namespace

Drift trend_over(std::span<const double> blocks) {
  if (blocks.size() < 4) return {};
  std::vector<double> place;
  for (std::size_t b = 0; b < blocks.size(); ++b)
    place.push_back((static_cast<double>(b) + 0.5) / static_cast<double>(blocks.size()));
  const auto line = statistics::fit_line(place, blocks);
  if (!line) return {};
  double square = 0, neighbours = 0, before = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const double residual = blocks[b] - line->intercept - line->slope * place[b];
    square += residual * residual;
    neighbours += residual * before;
    before = residual;
  }
  const double correlation = square > 0 ? std::max(0.0, neighbours / square) : 0;
  const double variance = line->var_slope * line->reduced_chi_squared() * (1 + 2 * correlation);
  return {line->slope, interval_factor(blocks.size()) * std::sqrt(variance)};
}

Steadiness steadiness(const TimeSeries& series, double rotation, std::size_t batches) {
  Steadiness result;
  const std::size_t count = series.time.size();
  if (count < least_snapshots)
    object(result, fmt::format("{} snapshots are fewer than {}", count, least_snapshots));
  if (rotation != 0 && count > 1) {
    const double turn = 2 * std::numbers::pi / std::abs(rotation);
    const double snapshots = static_cast<double>(count);
    result.turns = (series.time.back() - series.time.front()) * snapshots / (snapshots - 1) / turn;
    result.turns_before = std::abs(series.wall_angle.front()) / (2 * std::numbers::pi);
    if (result.turns < least_turns)
      object(result, fmt::format("{:.2f} turns were measured, less than one", result.turns));
    if (result.turns_before < least_turns)
      object(result,
             fmt::format("{:.2f} turns before the first snapshot are less than one", result.turns_before));
  }
  if (!judge_path(series, result)) return result;
  const bool energy_is_vague = !judge_energy(series, batches, result);
  if (!series.mass_angle.empty()) {
    std::vector<double> degrees;
    for (double angle : series.mass_angle) degrees.push_back(angle * 180 / std::numbers::pi);
    result.slope_deg = drift_of(degrees, batches);
    result.slope_std_deg = standard_deviation(degrees);
    if (counts(result.slope_deg, slope_that_matters))
      object(result,
             fmt::format("the slope changes by {:.2f} +- {:.2f} deg from the first half to the second",
                         result.slope_deg.value, result.slope_deg.ci99));
  }
  result.judged_by = series.mass_angle.empty() ? "kinetic energy" : "kinetic energy and slope";
  const bool packing_tells = judge_packing(series, batches, result);
  if (!energy_is_vague) return result;
  if (packing_tells)
    result.judged_by = "stress and shear rate";
  else
    object(result, change_of("kinetic energy fluctuates too much to tell: it changes", result.energy));
  return result;
}

}  // namespace drumlin::particles
