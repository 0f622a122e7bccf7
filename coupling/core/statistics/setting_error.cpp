#include "coupling/core/statistics/setting_error.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/straight_line.hpp"

namespace drumlin::statistics {
namespace {

constexpr double near = 5;

std::set<double> settings_of(const std::vector<SettingPoint>& points) {
  std::set<double> settings;
  for (const SettingPoint& p : points) settings.insert(p.setting);
  return settings;
}

struct PowerFit {
  SettingError found;
  double chi_squared = 0;
  double factor = 0;  ///< half width of the 99 % interval per root of the variance
};

// value = limit + C x, x = setting^power, read off at `setting`.
PowerFit fitted(const std::vector<SettingPoint>& points, double setting, double power) {
  const bool stated =
      std::all_of(points.begin(), points.end(), [](const SettingPoint& p) { return p.ci99 > 0; });
  std::vector<double> x, y, variance;
  for (const SettingPoint& p : points) {
    x.push_back(std::pow(p.setting, power));
    y.push_back(p.value);
    variance.push_back(stated ? std::pow(p.ci99 / normal_quantile_99, 2) : 1);
  }
  const auto line = fit_line(x, y, variance);  // three different settings at least
  const double at = std::pow(setting, power);
  const double factor = interval_factor_99(*line, stated ? Variances::stated : Variances::relative);
  return {{line->slope * at, factor * std::sqrt(line->var_slope) * at, power, 0}, line->chi_squared, factor};
}

// The power that fits best. The others are open as well, as long as their chi^2 exceeds its by no more than a
// coefficient's does at the end of its 99 % interval: the interval covers theirs, too.
SettingError best_of(const std::vector<PowerFit>& fits) {
  const auto by_misfit = [](const PowerFit& a, const PowerFit& b) { return a.chi_squared < b.chi_squared; };
  const PowerFit& best = *std::min_element(fits.begin(), fits.end(), by_misfit);
  SettingError result = best.found;
  for (const PowerFit& other : fits)
    if (other.chi_squared <= best.chi_squared + best.factor * best.factor)
      result.ci99 = std::max(result.ci99, std::abs(other.found.error - result.error) + other.found.ci99);
  return result;
}

}  // namespace

bool SettingError::significant() const { return std::abs(error) > ci99; }

std::optional<SettingError> setting_error(std::span<const SettingPoint> all, double setting,
                                          std::span<const double> powers) {
  const auto within = [&](double factor) {
    std::vector<SettingPoint> chosen;
    for (const SettingPoint& p : all)
      if (std::isfinite(p.value) && p.setting > 0 && p.setting <= factor * setting &&
          setting <= factor * p.setting)
        chosen.push_back(p);
    return chosen;
  };
  std::vector<SettingPoint> points = within(near);
  if (settings_of(points).size() < 3) points = within(INFINITY);
  const std::set<double> settings = settings_of(points);
  if (settings.size() < 3) return std::nullopt;
  std::vector<PowerFit> fits;
  for (const double power : powers) fits.push_back(fitted(points, setting, power));
  SettingError best = best_of(fits);
  best.smallest = *settings.begin();
  return best;
}

}  // namespace drumlin::statistics
