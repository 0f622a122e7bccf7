#include "coupling/study/collapse.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/statistics/quantiles.hpp"
#include "coupling/statistics/samples.hpp"

namespace drumlin::coupling {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double surface_margin = 2, wall_margin = 3;  // d
constexpr int points_per_decade = 4;

double wall_of(const ProfileSet& profiles) {
  return profiles.header.wall_z ? *profiles.header.wall_z : profiles.z.front();
}

/// Interpolation in ln I; NaN outside the curve.
Scalar value_at(const InertialCurve& curve, double I) {
  const auto above = std::lower_bound(curve.I.begin(), curve.I.end(), I);
  if (above == curve.I.end() || (above == curve.I.begin() && *above > I)) return {"", nan, nan};
  const auto i = static_cast<std::size_t>(above - curve.I.begin());
  if (i == 0) return {"", curve.value[0], curve.ci99[0]};
  const double share = std::log(I / curve.I[i - 1]) / std::log(curve.I[i] / curve.I[i - 1]);
  return {"", (1 - share) * curve.value[i - 1] + share * curve.value[i],
          (1 - share) * curve.ci99[i - 1] + share * curve.ci99[i]};
}

/// Speeds at one I, each with its pooled value.
CollapsePoint point_at(double I, const std::vector<std::vector<InertialCurve>>& speeds) {
  std::vector<std::vector<Scalar>> runs;
  for (const auto& curves : speeds) {
    runs.emplace_back();
    for (const InertialCurve& curve : curves) runs.back().push_back(value_at(curve, I));
  }
  std::vector<double> values, variances;
  for (const Scalar& speed : pooled_speeds("", runs)) {
    if (!std::isfinite(speed.value) || !(speed.ci99.value_or(0) > 0)) continue;
    values.push_back(speed.value);
    variances.push_back(std::pow(*speed.ci99 / statistics::normal_quantile_99, 2));
  }
  if (values.size() < 2) return {I, 0, 0, 0, values.size()};
  const auto mean = statistics::weighted_mean(values, variances);
  return {I, mean.value, std::sqrt(statistics::variance(values)), mean.chi_squared, values.size()};
}

}  // namespace

InertialCurve inertial_curve(const ProfileSet& profiles, const std::string& column) {
  const ProfileColumn *inertial = profiles.find("I"), *rate = profiles.find("shear_rate");
  const ProfileColumn* quantity = profiles.find(column);
  InertialCurve curve;
  if (inertial == nullptr || rate == nullptr || quantity == nullptr || profiles.z.empty()) return curve;
  const auto interval = [](const ProfileColumn& of, std::size_t l) {
    return of.ci99.empty() || !std::isfinite(of.ci99[l]) ? 0 : of.ci99[l];
  };
  std::vector<double> inertial_ci99;
  const double wall = wall_of(profiles);
  for (std::size_t l = profiles.z.size(); l-- > 0;) {
    if (profiles.z[l] > -surface_margin) continue;
    if (profiles.z[l] < wall + wall_margin || !(rate->value[l] > interval(*rate, l))) break;
    if (!std::isfinite(quantity->value[l])) continue;
    if (!curve.I.empty() && inertial->value[l] >= curve.I.back()) continue;
    curve.I.push_back(inertial->value[l]);
    curve.value.push_back(quantity->value[l]);
    curve.ci99.push_back(interval(*quantity, l));
    inertial_ci99.push_back(interval(*inertial, l));
  }
  for (auto* values : {&curve.I, &curve.value, &curve.ci99, &inertial_ci99})
    std::reverse(values->begin(), values->end());
  for (std::size_t i = 0; i < curve.I.size() && curve.I.size() > 1; ++i) {
    const std::size_t before = i > 0 ? i - 1 : 0, after = std::min(i + 1, curve.I.size() - 1);
    const double slope =
        (curve.value[after] - curve.value[before]) / std::log(curve.I[after] / curve.I[before]);
    curve.ci99[i] = std::hypot(curve.ci99[i], slope * inertial_ci99[i] / curve.I[i]);
  }
  return curve;
}

Collapse collapse_of(const std::string& column, const std::vector<StudyRun>& runs,
                     const std::vector<SpeedGroup>& groups, double I_min, double I_max) {
  std::vector<std::vector<InertialCurve>> speeds;
  for (const SpeedGroup& group : groups) {
    speeds.emplace_back();
    for (const std::size_t r : group.runs) speeds.back().push_back(inertial_curve(runs[r].profiles, column));
  }
  Collapse result{column, {}, nan, nan, nan, nan, false};
  const int steps = static_cast<int>(std::lround(points_per_decade * std::log10(I_max / I_min)));
  double chi2 = 0, squares = 0, low = std::numeric_limits<double>::infinity(), high = -low;
  std::size_t freedom = 0, most_speeds = 0;
  for (int step = 0; step <= steps; ++step) {
    const CollapsePoint point = point_at(I_min * std::pow(10.0, double(step) / points_per_decade), speeds);
    if (point.speeds < 2) continue;
    result.points.push_back(point);
    chi2 += point.chi2;
    freedom += point.speeds - 1;
    most_speeds = std::max(most_speeds, point.speeds);
    squares += point.spread * point.spread;
    low = std::min(low, point.mean);
    high = std::max(high, point.mean);
  }
  if (freedom == 0) return result;
  const auto most_freedom = static_cast<int>(most_speeds - 1);
  result.ratio = std::sqrt(chi2 / static_cast<double>(freedom));
  result.limit = std::sqrt(statistics::chi_squared_quantile_99(most_freedom) / most_freedom);
  result.spread = std::sqrt(squares / static_cast<double>(result.points.size()));
  result.range = high - low;
  result.collapse = result.ratio <= result.limit;
  return result;
}

}  // namespace drumlin::coupling
