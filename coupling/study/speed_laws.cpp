#include "coupling/study/speed_laws.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

namespace drumlin::coupling {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = std::numbers::pi / 180;

Scalar scalar_of(const SpeedGroup& group, const std::string& name) {
  const Scalar* found = group.scalars.find(name);
  return found == nullptr ? Scalar{name, nan, std::nullopt} : *found;
}

LawPoint point_of(const Scalar& x, const Scalar& y) {
  return {x.value, y.value, x.ci99.value_or(nan), y.ci99.value_or(nan)};
}

std::vector<LawPoint> points_of(const std::vector<SpeedGroup>& groups, const std::string& x,
                                const std::string& y) {
  std::vector<LawPoint> points;
  for (const SpeedGroup& group : groups) points.push_back(point_of(scalar_of(group, x), scalar_of(group, y)));
  return points;
}

SpeedLaw law_of(const std::string& name, const std::string& formula, const std::vector<std::string>& names,
                const LawFit& fit) {
  SpeedLaw law{name, formula, {}, fit.reduced_chi2, fit.rms, fit.points};
  for (std::size_t i = 0; i < names.size(); ++i)
    law.coefficients.push_back({names[i], fit.coefficients[i].value, fit.coefficients[i].ci99});
  return law;
}

SpeedLaw depth_law(const std::vector<SpeedGroup>& groups) {
  std::vector<LawPoint> points = points_of(groups, "Q", "H");
  for (LawPoint& point : points) {
    point.x = std::sqrt(point.x);
    point.x_ci99 /= 2 * point.x;
  }
  return law_of("flowing_layer_depth", "H = c sqrt(Q)", {"c"}, fit_proportional(points));
}

/// sqrt(sin(theta) - sin(Phi)) / sqrt(cos(Phi)); NaN for a slope below Phi.
std::vector<LawPoint> against_scaling(const std::vector<SpeedGroup>& groups, const std::string& slope,
                                      double Phi_deg) {
  std::vector<LawPoint> points = points_of(groups, slope, "shear_rate");
  for (LawPoint& point : points) {
    const double theta = point.x * degree;
    const double cosine = std::cos(Phi_deg * degree);
    point.x = std::sqrt((std::sin(theta) - std::sin(Phi_deg * degree)) / cosine);
    point.x_ci99 *= degree * std::cos(theta) / (2 * point.x * cosine);
  }
  return points;
}

/// Rajchenbach's scaling without and with an offset, Phi = atan(c0) of the friction law.
void add_shear_rate_laws(std::vector<SpeedLaw>& laws, const std::vector<SpeedGroup>& groups,
                         const std::string& slope, const std::string& suffix,
                         const SpeedLaw::Coefficient& c0) {
  const double Phi = std::atan(c0.value) / degree;
  const double Phi_ci99 = c0.ci99 / (1 + c0.value * c0.value) / degree;
  const auto points = against_scaling(groups, slope, Phi);
  SpeedLaw scaling = law_of("shear_rate" + suffix,
                            "shear_rate = c sqrt(sin(theta) - sin(Phi)) / sqrt(cos(Phi)), Phi = atan(c0)",
                            {"c"}, fit_proportional(points));
  // c follows from Phi too.
  const auto c_at = [&](double angle) {
    return fit_proportional(against_scaling(groups, slope, angle)).coefficients[0].value;
  };
  auto& c = scaling.coefficients[0];
  if (std::isfinite(Phi_ci99)) c.ci99 = std::hypot(c.ci99, (c_at(Phi + Phi_ci99) - c_at(Phi - Phi_ci99)) / 2);
  scaling.coefficients.push_back({"Phi_deg", Phi, Phi_ci99});
  laws.push_back(scaling);
  laws.push_back(law_of("shear_rate_with_offset" + suffix,
                        "shear_rate = g0 + c sqrt(sin(theta) - sin(Phi)) / sqrt(cos(Phi)), Phi = atan(c0)",
                        {"g0", "c"}, fit_line(points)));
}

double rms_about(const std::vector<FrictionPoint>& points, const LogFriction& law) {
  double squares = 0;
  for (const FrictionPoint& point : points)
    squares += std::pow(point.mu - law.a - law.b * std::log(point.I), 2);
  return std::sqrt(squares / static_cast<double>(points.size()));
}

}  // namespace

std::vector<SpeedLaw> speed_laws(const std::vector<SpeedGroup>& groups) {
  std::vector<SpeedLaw> laws{depth_law(groups), law_of("flowing_layer_depth_power", "H = c Q^p", {"c", "p"},
                                                       fit_power(points_of(groups, "Q", "H")))};
  for (const auto& [slope, friction, suffix] :
       {std::tuple<std::string, std::string, std::string>{"theta_deg", "mu_eff", ""},
        {"theta_com_deg", "mu_eff_com", "_com"}}) {
    laws.push_back(law_of("effective_friction" + suffix, "tan(theta) = c0 + c1 Q", {"c0", "c1"},
                          fit_line(points_of(groups, "Q", friction))));
    const SpeedLaw::Coefficient c0 = laws.back().coefficients[0];
    add_shear_rate_laws(laws, groups, slope, suffix, c0);
  }
  laws.push_back(law_of("shear_rate_power", "shear_rate = c Q^p", {"c", "p"},
                        fit_power(points_of(groups, "Q", "shear_rate"))));
  return laws;
}

namespace {

/// Mean of the speeds. Its half width is the larger of what their intervals give and Student's t of their
/// spread: where the quantity depends on the speed, the mean of other speeds would be another.
Scalar mean_of_speeds(const std::string& name, const std::vector<LawPoint>& points) {
  std::vector<LawPoint> plain;
  double squares = 0;
  bool known = true;
  for (const LawPoint& point : points) {
    if (!std::isfinite(point.y)) continue;
    plain.push_back({1, point.y});
    squares += point.y_ci99 * point.y_ci99;
    known = known && std::isfinite(point.y_ci99);
  }
  Scalar mean{name, nan, std::nullopt};
  if (plain.empty()) return mean;
  const LawFit fit = fit_proportional(plain);
  mean.value = fit.coefficients[0].value;
  const double spread = fit.coefficients[0].ci99;
  const double combined = std::sqrt(squares) / static_cast<double>(plain.size());
  if (known && std::isfinite(combined)) mean.ci99 = std::fmax(combined, spread);
  return mean;
}

}  // namespace

SpeedTrend speed_trend(const std::string& quantity, const std::vector<SpeedGroup>& groups) {
  const auto points = points_of(groups, "Q", quantity);
  std::vector<LawPoint> constant;
  double least = std::numeric_limits<double>::infinity(), greatest = -least;
  for (const LawPoint& point : points) {
    constant.push_back({1, point.y, nan, point.y_ci99});
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) continue;
    least = std::min(least, point.x);
    greatest = std::max(greatest, point.x);
  }
  SpeedTrend result{
      quantity, mean_of_speeds(quantity, points), {quantity + "_trend", nan, std::nullopt}, nan};
  result.reduced_chi2 = fit_proportional(constant).reduced_chi2;
  const auto slope = fit_line(points).coefficients[1];
  const double gain = (greatest - least) / result.mean.value;
  result.trend.value = slope.value * gain;
  if (std::isfinite(slope.ci99)) result.trend.ci99 = std::abs(slope.ci99 * gain);
  return result;
}

std::optional<FrictionCollapse> friction_collapse(const std::vector<StudyRun>& runs,
                                                  const std::vector<SpeedGroup>& groups,
                                                  const LayerSelection& selection) {
  FrictionCollapse result;
  std::vector<FrictionPoint> all;
  std::vector<std::vector<FrictionPoint>> of_speeds;
  double squares = 0, errors = 0;
  for (const SpeedGroup& group : groups) {
    std::vector<FrictionPoint> points;
    for (const std::size_t r : group.runs) {
      const auto more = friction_points(runs[r].profiles, selection);
      points.insert(points.end(), more.begin(), more.end());
    }
    if (points.size() < 3) continue;
    result.speeds.push_back({group.rotation_rpm, fit_log_friction(points), 0});
    squares +=
        std::pow(rms_about(points, result.speeds.back().fit.law), 2) * static_cast<double>(points.size());
    for (const FrictionPoint& point : points) errors += point.mu_error;
    all.insert(all.end(), points.begin(), points.end());
    of_speeds.push_back(std::move(points));
  }
  if (all.empty()) return std::nullopt;
  result.common = fit_log_friction(all);
  for (std::size_t s = 0; s < of_speeds.size(); ++s)
    result.speeds[s].rms_about_common = rms_about(of_speeds[s], result.common.law);
  result.rms_own = std::sqrt(squares / static_cast<double>(all.size()));
  result.mean_error = errors / static_cast<double>(all.size());
  return result;
}

}  // namespace drumlin::coupling
