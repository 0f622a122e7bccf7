#include "coupling/core/results/profile_scalars.hpp"

#include <cmath>
#include <cstddef>
#include <optional>

#include "coupling/core/statistics/straight_line.hpp"

namespace drumlin {
namespace {

constexpr double none = ProfileScalars::none;

using statistics::StraightLine;

/// Least-squares line; nullopt with fewer than three points, through which every line would pass well enough.
std::optional<StraightLine> fitted_line(const std::vector<double>& x, const std::vector<double>& y) {
  return x.size() < 3 ? std::nullopt : statistics::fit_line(x, y);
}

/// Trapezoids over nu v_x. Layers without a grain carry nothing at the wall and above the surface; a gap
/// inside the packing would be a hole in the data and makes Q NaN.
double flow_rate(const std::vector<double>& z, const std::vector<double>& v_x,
                 const std::vector<double>& nu) {
  double sum = 0;
  std::optional<double> z_before;
  double flux_before = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    const double flux = nu[i] * v_x[i];
    if (!std::isfinite(flux)) {
      if (z_before && z[i] < 0) return none;
      continue;
    }
    if (z_before) sum += 0.5 * (flux + flux_before) * (z[i] - *z_before);
    z_before = z[i];
    flux_before = flux;
  }
  return z_before ? sum : none;
}

/// The straight part of v_x(z), from the surface downwards to where the speed falls below its share.
void fit_flowing_layer(const std::vector<double>& z, const std::vector<double>& v_x, double least_speed,
                       ProfileScalars& scalars) {
  std::vector<double> depth, speed;
  for (std::size_t i = z.size(); i-- > 0;) {
    if (z[i] > 0) continue;
    if (!(v_x[i] > least_speed)) break;
    depth.push_back(z[i]);
    speed.push_back(v_x[i]);
  }
  const auto line = fitted_line(depth, speed);
  if (!line || !(line->slope > 0)) return;
  scalars.shear_rate = line->slope;
  scalars.H = line->intercept / line->slope;
  scalars.fit_bottom = depth.back();
  scalars.fit_top = depth.front();
}

/// The exponential tail between two heights: ln rate = intercept + slope z.
std::optional<StraightLine> fitted_decay(const std::vector<double>& z, const std::vector<double>& rate,
                                         double from, double to) {
  std::size_t lowest = 0;
  while (lowest < z.size() && !std::isfinite(rate[lowest])) ++lowest;
  if (lowest == z.size() || z[lowest] > from) return std::nullopt;
  std::vector<double> depth, log_rate;
  for (std::size_t i = 0; i < z.size(); ++i) {
    if (z[i] < from || z[i] > to) continue;
    if (!(rate[i] > 0)) return std::nullopt;
    depth.push_back(z[i]);
    log_rate.push_back(std::log(rate[i]));
  }
  const auto line = fitted_line(depth, log_rate);
  return line && line->slope > 0 ? line : std::nullopt;
}

}  // namespace

ProfileScalars profile_scalars(const ProfileSet& profiles, const ProfileScalarOptions& options) {
  ProfileScalars scalars;
  const std::vector<double>& z = profiles.z;
  const std::vector<double>& v_x = profiles.column("v_x").value;
  scalars.surface_speed = interpolated(z, v_x, -options.surface_speed_depth);
  if (const auto* nu = profiles.find("nu")) scalars.Q = flow_rate(z, v_x, nu->value);
  if (!(scalars.surface_speed > 0)) return scalars;
  fit_flowing_layer(z, v_x, options.linear_share * scalars.surface_speed, scalars);
  if (!std::isfinite(scalars.H)) return scalars;
  if (const auto* rate = profiles.find(options.decay_of))
    if (const auto line =
            fitted_decay(z, rate->value, -scalars.H - options.decay_from, -scalars.H - options.decay_to)) {
      scalars.lambda = 1 / line->slope;
      scalars.decay_log_rate = line->intercept;
    }
  if (const auto* inertial = profiles.find("I")) scalars.I_th = interpolated(z, inertial->value, -scalars.H);
  return scalars;
}

double decay_length(const ProfileSet& profiles, double from, double to, const std::string& column) {
  const auto line = fitted_decay(profiles.z, profiles.column(column).value, from, to);
  return line ? 1 / line->slope : none;
}

}  // namespace drumlin
