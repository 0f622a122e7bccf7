#include "particles/measurement/layers/packing_scalars.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coupling/exchange/profile_scalars.hpp"
#include "coupling/statistics/straight_line.hpp"
#include "particles/measurement/frame/measurement_frame.hpp"

namespace drumlin::particles {
namespace {

constexpr double none = ProfileScalars::none;

struct Zone {
  double bottom = none, top = none;
};

/// Mean of value(layer) over the layers of a zone; NaN when there is none or one of them is NaN.
template <class Value>
double zone_mean_of(const ProfileSet& profiles, Zone zone, Value value) {
  if (!std::isfinite(zone.bottom) || !std::isfinite(zone.top)) return none;
  double sum = 0, count = 0;
  for (std::size_t l = 0; l < profiles.z.size(); ++l) {
    if (profiles.z[l] < zone.bottom || profiles.z[l] > zone.top) continue;
    sum += value(l);
    count += 1;
  }
  return count > 0 ? sum / count : none;
}

double zone_mean(const ProfileSet& profiles, Zone zone, const std::string& name) {
  const ProfileColumn* column = profiles.find(name);
  return column ? zone_mean_of(profiles, zone, [&](std::size_t l) { return column->value[l]; }) : none;
}

double zone_mean_of_ratio(const ProfileSet& profiles, Zone zone, const std::string& name,
                          const std::string& below) {
  const ProfileColumn *above = profiles.find(name), *under = profiles.find(below);
  if (!above || !under) return none;
  return zone_mean_of(profiles, zone, [&](std::size_t l) { return above->value[l] / under->value[l]; });
}

/// z where a profile that falls with height passes `level`, sought downwards from the top; linear between
/// layers.
double height_of(const ProfileSet& profiles, const std::vector<double>& value, double level) {
  for (std::size_t l = value.size(); l-- > 0;) {
    if (!(value[l] >= level)) continue;
    if (l + 1 == value.size() || !std::isfinite(value[l + 1])) return profiles.z[l];
    const double share = (value[l] - level) / (value[l] - value[l + 1]);
    return profiles.z[l] + share * (profiles.z[l + 1] - profiles.z[l]);
  }
  return none;
}

/// Distance from the wall at which the volume fraction first reaches `level`.
double wall_width(const ProfileSet& profiles, const std::vector<double>& nu, double wall_z, double level) {
  for (std::size_t l = 0; l < nu.size(); ++l) {
    if (!(nu[l] >= level)) continue;
    if (l == 0) return profiles.z[0] - wall_z;
    const double share = (level - nu[l - 1]) / (nu[l] - nu[l - 1]);
    return profiles.z[l - 1] + share * (profiles.z[l] - profiles.z[l - 1]) - wall_z;
  }
  return none;
}

/// Root mean square of v_x about the straight line of the flowing layer, over v_x(0).
double line_misfit(const ProfileSet& profiles, const ProfileScalars& fits) {
  const auto& v_x = profiles.column("v_x").value;
  const double square = zone_mean_of(profiles, {fits.fit_bottom, fits.fit_top}, [&](std::size_t l) {
    return std::pow(v_x[l] - fits.shear_rate * (profiles.z[l] + fits.H), 2);
  });
  return std::sqrt(square) / fits.surface_speed;
}

/// Largest mean of k over five neighbouring layers of a zone, and I in the middle of them. One layer alone
/// would be the largest of its errors.
struct Largest {
  double value = none, I = none;
};
Largest largest_k(const ProfileSet& profiles, Zone zone) {
  Largest found;
  const auto &k = profiles.column("k").value, &I = profiles.column("I").value;
  for (std::size_t l = 2; l + 2 < k.size(); ++l) {
    if (!(profiles.z[l - 2] >= zone.bottom) || !(profiles.z[l + 2] <= zone.top)) continue;
    const double mean = (k[l - 2] + k[l - 1] + k[l] + k[l + 1] + k[l + 2]) / 5;
    if (mean > found.value || !std::isfinite(found.value)) found = {mean, I[l]};
  }
  return found;
}

/// Exponent p of NAME/shear_rate ~ I^p: least squares through the logarithms, every layer alike.
double power_of_I(const ProfileSet& profiles, Zone zone, const std::string& name, double I_min) {
  const ProfileColumn* column = profiles.find(name);
  if (!column) return none;
  const auto &I = profiles.column("I").value, &rate = profiles.column("shear_rate").value;
  std::vector<double> log_I, log_ratio;
  for (std::size_t l = 0; l < profiles.z.size(); ++l) {
    if (!(profiles.z[l] >= zone.bottom && profiles.z[l] <= zone.top && I[l] >= I_min)) continue;
    const double ratio = std::log(column->value[l] / rate[l]);
    if (!std::isfinite(ratio)) continue;
    log_I.push_back(std::log(I[l]));
    log_ratio.push_back(ratio);
  }
  const auto line = log_I.size() < 3 ? std::nullopt : statistics::fit_line(log_I, log_ratio);
  return line ? line->slope : none;
}

void add_gradient_scalars(const ProfileSet& profiles, Zone flowing, Zone still, Zone whole,
                          ScalarSet& result) {
  if (!profiles.find("d_k_dx")) return;
  const auto add = [&](const std::string& name, double value) {
    result.scalars.push_back({name, value, {}});
  };
  const double dk_dx = zone_mean(profiles, whole, "d_k_dx");
  add("dk_dx", dk_dx);
  add("dk_dx_5", 10 * dk_dx);
  for (const auto& [name, column] :
       {std::pair("dnu_dx", "d_nu_dx"), std::pair("dv_dx", "d_v_x_dx"),
        std::pair("dsigma_zz_dx", "d_sigma_zz_dx"), std::pair("dsigma_xx_dx", "d_sigma_xx_dx"),
        std::pair("dsigma_xz_dx", "d_sigma_xz_dx")}) {
    add(std::string(name) + "_flowing", zone_mean(profiles, flowing, column));
    add(std::string(name) + "_static", zone_mean(profiles, still, column));
  }
}

}  // namespace

ScalarSet packing_scalars(const ProfileSet& profiles, const ProfilePlace& place,
                          const MeasurementOptions& options) {
  const ProfileScalars fits = profile_scalars(profiles, options.scalars);
  // The flowing layer: the layers of the straight line without the loose one at the surface.
  const Zone flowing{fits.fit_bottom, -options.scalars.surface_speed_depth};
  const double wall = place.wall_z + options.wall_margin;
  const Zone still{wall, -fits.H - options.scalars.decay_to};
  const Zone decay{-fits.H - options.scalars.decay_from, -fits.H - options.scalars.decay_to};
  const double margin = place.closed ? 0 : options.bulk_margin;
  const Zone bulk{place.wall_z + margin, -margin};
  const Zone whole{wall, -2};
  const auto& nu = profiles.column("nu").value;
  const double nu_bulk = zone_mean(profiles, bulk, "nu");
  // Mass per area: nu, where all grains have one density.
  const double weight = profiles.find("density") ? zone_mean(profiles, bulk, "density") : nu_bulk;
  const auto over_weight = [&](const std::string& name, Zone zone, double share) {
    const auto& stress = profiles.column(name).value;
    zone.top = std::min(zone.top, -2.0);  // above it the surface's own width is most of the weight
    return zone_mean_of(profiles, zone,
                        [&](std::size_t l) { return stress[l] / (-profiles.z[l] * weight * share); });
  };
  const double cosine = std::cos(place.frame_angle), sine = std::sin(place.frame_angle);
  const Largest k = largest_k(profiles, {wall, -fits.H});
  const double I_min = options.fluctuation_I_min;
  ScalarSet result{{{"Q", fits.Q, {}},
                    {"H", fits.H, {}},
                    {"lambda", fits.lambda, {}},
                    {"shear_rate", fits.shear_rate, {}},
                    {"surface_speed", fits.surface_speed, {}},
                    {"line_misfit", line_misfit(profiles, fits), {}},
                    {"layer_balance", 0.4 * fits.shear_rate * fits.H * fits.H / fits.Q, {}},
                    {"I_th", fits.I_th, {}},
                    {"nu_bulk", nu_bulk, {}},
                    {"nu_surface_width",
                     height_of(profiles, nu, 0.05 * nu_bulk) - height_of(profiles, nu, 0.95 * nu_bulk),
                     {}},
                    {"nu_wall_width", wall_width(profiles, nu, place.wall_z, 0.95 * nu_bulk), {}},
                    {"spin_over_half_vorticity",
                     2 * zone_mean(profiles, flowing, "omega") / zone_mean(profiles, flowing, "shear_rate"),
                     {}},
                    {"spin_over_half_curl",
                     zone_mean(profiles, flowing, "omega") / zone_mean(profiles, flowing, "half_vorticity"),
                     {}},
                    {"spin_over_half_vorticity_static",
                     2 * zone_mean(profiles, decay, "omega") / zone_mean(profiles, decay, "shear_rate"),
                     {}},
                    {"sigma_zz_over_weight_flowing", over_weight("sigma_zz", flowing, cosine), {}},
                    {"sigma_zz_over_weight_static", over_weight("sigma_zz", still, cosine), {}},
                    {"sigma_xz_over_weight_flowing", over_weight("sigma_xz", flowing, sine), {}},
                    {"sigma_xz_over_weight_static", over_weight("sigma_xz", still, sine), {}},
                    {"dv_over_shear", zone_mean_of_ratio(profiles, flowing, "dv", "shear_rate"), {}},
                    {"domega_over_shear", zone_mean_of_ratio(profiles, flowing, "domega", "shear_rate"), {}},
                    {"dv_exponent", power_of_I(profiles, {wall, -fits.H}, "dv", I_min), {}},
                    {"domega_exponent", power_of_I(profiles, {wall, -fits.H}, "domega", I_min), {}},
                    {"k_flowing", zone_mean(profiles, flowing, "k"), {}},
                    {"k_maximum", k.value, {}},
                    {"I_at_k_maximum", k.I, {}},
                    {"k_boundary", zone_mean(profiles, {wall, wall + 5}, "k"), {}},
                    {"coordination_flowing", zone_mean(profiles, flowing, "coordination"), {}},
                    {"coordination_static", zone_mean(profiles, still, "coordination"), {}}}};
  add_gradient_scalars(profiles, flowing, still, whole, result);
  if (place.closed)  // there is neither surface nor wall
    for (Scalar& scalar : result.scalars)
      if (scalar.name == "nu_surface_width" || scalar.name == "nu_wall_width" || scalar.name == "k_boundary")
        scalar.value = none;
  return result;
}

}  // namespace drumlin::particles
