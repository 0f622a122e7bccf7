#include "coupling/accuracy/setting_error.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace drumlin {
namespace {

constexpr double near = 5;

std::set<double> settings_of(const std::vector<SettingPoint>& points) {
  std::set<double> settings;
  for (const SettingPoint& p : points) settings.insert(p.setting);
  return settings;
}

struct Line {
  double slope = 0, slope_ci99 = 0, misfit = INFINITY;
};

// value = limit + slope x, x = setting^power.
Line fitted(const std::vector<SettingPoint>& points, double power) {
  const bool weighted =
      std::all_of(points.begin(), points.end(), [](const SettingPoint& p) { return p.ci99 > 0; });
  double w = 0, x = 0, y = 0;
  const auto weight = [&](const SettingPoint& p) { return weighted ? 1 / (p.ci99 * p.ci99) : 1; };
  for (const SettingPoint& p : points) {
    w += weight(p);
    x += weight(p) * std::pow(p.setting, power);
    y += weight(p) * p.value;
  }
  x /= w, y /= w;
  double xx = 0, xy = 0;
  for (const SettingPoint& p : points) {
    const double dx = std::pow(p.setting, power) - x;
    xx += weight(p) * dx * dx;
    xy += weight(p) * dx * (p.value - y);
  }
  Line line;
  line.slope = xy / xx;
  line.misfit = 0;
  for (const SettingPoint& p : points)
    line.misfit += weight(p) * std::pow(p.value - y - line.slope * (std::pow(p.setting, power) - x), 2);
  const double freedom = static_cast<double>(points.size()) - 2;
  // Weights are 1/ci99^2, so that the root of the variance is the half width itself.
  const double scatter = std::sqrt(line.misfit / freedom);
  line.slope_ci99 = (weighted ? std::max(1.0, scatter) : 2.576 * scatter) / std::sqrt(xx);
  return line;
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
  std::optional<SettingError> best;
  double least = INFINITY;
  for (const double power : powers) {
    const Line line = fitted(points, power);
    if (!(line.misfit < least)) continue;
    least = line.misfit;
    const double x = std::pow(setting, power);
    best = SettingError{line.slope * x, line.slope_ci99 * x, power, *settings.begin()};
  }
  return best;
}

}  // namespace drumlin
