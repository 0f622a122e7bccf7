#include "coupling/calibration/centre_friction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/core/statistics/resampling.hpp"

namespace drumlin::coupling {
namespace {

FrictionFit fit_of(const ProfileSet& profiles, const LayerSelection& selection) {
  const double nan = std::nan("");
  const auto points = friction_points(profiles, selection);
  return points.size() < 3 ? FrictionFit{.law = {nan, nan, {nan, nan, nan}, nan, nan}}
                           : fit_log_friction(points);
}

double half_width_of_parts(std::span<const double> leave_one_out, double interval_factor) {
  if (leave_one_out.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  return interval_factor * std::sqrt(statistics::jackknife_variance(leave_one_out));
}

}  // namespace

LogLaw friction_with_borrowed_intervals(ProfileSet profiles, const ProfileSet& measured,
                                        const LayerSelection& selection) {
  profiles.header = measured.header;
  for (ProfileColumn& column : profiles.columns) {
    if (column.name != "I" && column.name != "mu") continue;
    const auto& known = measured.column(column.name).ci99;
    column.ci99.assign(profiles.z.size(), std::nan(""));
    for (std::size_t l = 0; l < profiles.z.size() && !known.empty(); ++l) {
      const auto above = std::lower_bound(measured.z.begin(), measured.z.end(), profiles.z[l]);
      auto nearest = above == measured.z.end() ? above - 1 : above;
      if (nearest != measured.z.begin() && profiles.z[l] - *(nearest - 1) < *nearest - profiles.z[l])
        --nearest;
      column.ci99[l] = known[static_cast<std::size_t>(nearest - measured.z.begin())];
    }
  }
  return fit_of(profiles, selection).law;
}

CentreFriction centre_friction(const ProfileSet& profiles, std::span<const ProfileSet> leave_one_out,
                               double interval_factor, const LayerSelection& selection) {
  const FrictionFit fit = fit_of(profiles, selection);
  std::vector<double> a, b;
  for (const ProfileSet& without : leave_one_out) {
    const LogLaw one = friction_with_borrowed_intervals(without, profiles, selection);
    a.push_back(one.a);
    b.push_back(one.b);
  }
  const auto& [var_a, covariance, var_b] = fit.law.covariance;
  const auto ci99 = [&](std::span<const double> parts, double variance) {
    return std::hypot(half_width_of_parts(parts, interval_factor), half_width_99(fit, variance));
  };
  return {fit.law, {{{"mu_a", fit.law.a, ci99(a, var_a)}, {"mu_b", fit.law.b, ci99(b, var_b)}}}};
}

std::vector<FrictionVariant> friction_variants(const ProfileSet& profiles, const LayerSelection& selection) {
  std::vector<FrictionVariant> variants;
  const auto add = [&](const std::string& change, const LayerSelection& changed) {
    variants.push_back({change, fit_of(profiles, changed).law});
  };
  LayerSelection changed = selection;
  for (double factor : {0.1, 10.0}) {
    changed.I_min = factor * selection.I_min;
    add(fmt::format("mu(I) from I = {}", changed.I_min), changed);
  }
  changed = selection;
  changed.I_max = 0.3 * selection.I_max;
  add(fmt::format("mu(I) up to I = {}", changed.I_max), changed);
  changed = selection;
  changed.surface_margin = 2 * selection.surface_margin;
  add(fmt::format("mu(I) from {} d below the surface", changed.surface_margin), changed);
  changed = selection;
  changed.wall_margin = 3 * selection.wall_margin;
  add(fmt::format("mu(I) from {} d above the wall", changed.wall_margin), changed);
  return variants;
}

}  // namespace drumlin::coupling
