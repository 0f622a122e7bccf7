#include "coupling/calibration/log_friction.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/straight_line.hpp"

namespace drumlin::coupling {
namespace {

/// Half widths of the profile's 99 % intervals per standard error; that of the normal distribution unless it
/// says.
double interval_factor(const ProfileSet& profiles) { return profiles.header.interval_factor.value_or(2.576); }

constexpr double least_variance = 1e-100;  // of points exactly on a line: their weights must stay finite

using Line = statistics::StraightLine;  // mu over ln I

/// Weighted straight line through (ln I, mu); `variance` of each point's mu.
Line weighted_line(const std::vector<FrictionPoint>& points, const std::vector<double>& variance) {
  std::vector<double> log_I, mu;
  for (const FrictionPoint& point : points) {
    log_I.push_back(std::log(point.I));
    mu.push_back(point.mu);
  }
  return *statistics::fit_line(log_I, mu, variance);
}

double residual(const FrictionPoint& point, const Line& line) {
  return point.mu - line.intercept - line.slope * std::log(point.I);
}

double sum_of_squares(const std::vector<FrictionPoint>& points, const Line& line) {
  double sum = 0;
  for (const FrictionPoint& point : points) sum += std::pow(residual(point, line), 2);
  return sum;
}

/// Variance of each point's mu about a line of slope b.
std::vector<double> variances(const std::vector<FrictionPoint>& points, double b, double scatter_squared) {
  std::vector<double> result;
  for (const FrictionPoint& point : points)
    result.push_back(std::pow(known(point.mu_error), 2) + std::pow(b * known(point.I_error) / point.I, 2) +
                     scatter_squared);
  return result;
}

/// Line for a given intrinsic scatter. The weights depend on the slope: a few rounds settle them, for errors
/// of I count little where mu grows slowly.
Line line_with_scatter(const std::vector<FrictionPoint>& points, double first_b, double scatter_squared) {
  Line line;
  line.slope = first_b;
  for (int round = 0; round < 20; ++round)
    line = weighted_line(points, variances(points, line.slope, scatter_squared));
  return line;
}

double reduced_chi_squared(const std::vector<FrictionPoint>& points, const Line& line,
                           double scatter_squared) {
  const auto variance = variances(points, line.slope, scatter_squared);
  double sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) sum += std::pow(residual(points[i], line), 2) / variance[i];
  return sum / static_cast<double>(points.size() - 2);
}

/// The s^2 at which the reduced chi^2 is one, by halving: it falls as s^2 grows.
double scatter_squared(const std::vector<FrictionPoint>& points, double first_b, double upper_bound) {
  double low = 0, high = upper_bound;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = (low + high) / 2;
    const Line line = line_with_scatter(points, first_b, middle);
    (reduced_chi_squared(points, line, middle) > 1 ? low : high) = middle;
  }
  return high;
}

void check(const std::vector<FrictionPoint>& points) {
  if (points.size() < 3)
    throw InputError("mu(I) needs at least 3 layers within the range of I, there are " +
                     std::to_string(points.size()));
  const auto [low, high] = std::minmax_element(points.begin(), points.end(),
                                               [](const auto& p, const auto& q) { return p.I < q.I; });
  if (!(low->I > 0) || !(low->I < high->I)) throw InputError("mu(I) needs layers of different positive I");
}

}  // namespace

std::vector<FrictionPoint> friction_points(const ProfileSet& profiles, const LayerSelection& selection,
                                           const std::string& of) {
  const ProfileColumn& inertial = profiles.column("I");
  const ProfileColumn& friction = profiles.column(of);
  const double wall_z = profiles.header.wall_z.value_or(profiles.z.empty() ? 0 : profiles.z.front());
  const double factor = interval_factor(profiles);
  const auto error = [factor](const ProfileColumn& column, std::size_t l) {
    return column.ci99.empty() ? std::numeric_limits<double>::quiet_NaN() : column.ci99[l] / factor;
  };
  std::vector<FrictionPoint> points;
  for (std::size_t l = 0; l < profiles.z.size(); ++l) {
    const double I = inertial.value[l];
    const bool deep_enough = profiles.z[l] <= -selection.surface_margin;
    const bool off_the_wall = profiles.z[l] >= wall_z + selection.wall_margin;
    if (!deep_enough || !off_the_wall || !(I >= selection.I_min && I <= selection.I_max)) continue;
    if (!std::isfinite(friction.value[l])) continue;
    points.push_back({I, friction.value[l], error(inertial, l), error(friction, l)});
  }
  return points;
}

FrictionFit fit_log_friction(const std::vector<FrictionPoint>& points) {
  check(points);
  const auto freedom = static_cast<double>(points.size() - 2);
  const Line plain = weighted_line(points, std::vector<double>(points.size(), 1.0));
  const double squares = sum_of_squares(points, plain);
  const auto errors = variances(points, plain.slope, 0);
  const bool all_known = *std::min_element(errors.begin(), errors.end()) > 0;

  FrictionFit fit;
  fit.points = points.size();
  fit.birge_ratio = std::numeric_limits<double>::quiet_NaN();
  Line line;
  if (all_known) {
    line = line_with_scatter(points, plain.slope, 0);
    fit.birge_ratio = std::sqrt(reduced_chi_squared(points, line, 0));
  }
  if (!(fit.birge_ratio <= 1)) {
    // squares/freedom is the scatter of points without errors; with any errors s is below, 4 covers the
    // weights.
    const double s2 = std::max(scatter_squared(points, plain.slope, 4 * squares / freedom), least_variance);
    fit.intrinsic_scatter = std::sqrt(s2);
    line = line_with_scatter(points, plain.slope, s2);
  }
  fit.law.a = line.intercept;
  fit.law.b = line.slope;
  fit.law.covariance = {line.var_intercept, line.covariance, line.var_slope};
  fit.rms_misfit = std::sqrt(sum_of_squares(points, line) / static_cast<double>(points.size()));
  fit.law.I_min = fit.law.I_max = points.front().I;
  for (const FrictionPoint& point : points) {
    fit.law.I_min = std::min(fit.law.I_min, point.I);
    fit.law.I_max = std::max(fit.law.I_max, point.I);
  }
  return fit;
}

double half_width_99(const FrictionFit& fit, double variance) {
  // With an intrinsic scatter the reduced chi^2 is one, and the scatter is what the points say.
  const double reduced_chi2 = fit.birge_ratio <= 1 ? fit.birge_ratio * fit.birge_ratio : 1;
  return std::sqrt(variance) *
         statistics::quantile_99_of_stated_errors(reduced_chi2, static_cast<int>(fit.points) - 2);
}

}  // namespace drumlin::coupling
