#include "particles/measurement/layers/scalars.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "coupling/core/results/layer_ratios.hpp"
#include "coupling/core/results/profile_scalars.hpp"
#include "coupling/core/statistics/straight_line.hpp"
#include "particles/measurement/frame/measurement_frame.hpp"

namespace drumlin::particles {
namespace {

using Of = LayerValues;
using Layers = std::vector<LayerValues>;

struct Zone {
  double bottom = Of::none, top = Of::none;
};

ScalarSet scalars_of(std::initializer_list<std::pair<const char*, double>> values) {
  ScalarSet set;
  for (const auto& [name, value] : values) set.scalars.push_back({name, value, {}});
  return set;
}

/// Mean of a quantity, or of value(layer), over the layers of a zone; NaN without a zone, or when one of
/// them is NaN.
template <class Value>
double mean_over(const Layers& layers, Zone zone, Value value) {
  if (!std::isfinite(zone.bottom) || !std::isfinite(zone.top)) return Of::none;
  double sum = 0, count = 0;
  for (const LayerValues& layer : layers) {
    if (layer.z < zone.bottom || layer.z > zone.top) continue;
    sum += std::invoke(value, layer);
    count += 1;
  }
  return count > 0 ? sum / count : Of::none;
}

double mean_of_ratio(const Layers& layers, Zone zone, double Of::*above, double Of::*below) {
  return mean_over(layers, zone, [&](const Of& layer) { return layer.*above / layer.*below; });
}

/// z where nu, which falls with height, passes `level`, sought downwards from the top; linear between layers.
double height_of(const Layers& layers, double level) {
  for (std::size_t l = layers.size(); l-- > 0;) {
    const LayerValues& here = layers[l];
    if (!(here.nu >= level)) continue;
    if (l + 1 == layers.size() || !std::isfinite(layers[l + 1].nu)) return here.z;
    const double share = (here.nu - level) / (here.nu - layers[l + 1].nu);
    return here.z + share * (layers[l + 1].z - here.z);
  }
  return Of::none;
}

/// Distance from the wall at which the volume fraction first reaches `level`.
double wall_width(const Layers& layers, double wall_z, double level) {
  for (std::size_t l = 0; l < layers.size(); ++l) {
    if (!(layers[l].nu >= level)) continue;
    if (l == 0) return layers[0].z - wall_z;
    const LayerValues& below = layers[l - 1];
    const double share = (level - below.nu) / (layers[l].nu - below.nu);
    return below.z + share * (layers[l].z - below.z) - wall_z;
  }
  return Of::none;
}

/// Root mean square of v_x about the straight line of the flowing layer, over v_x(0).
double line_misfit(const Layers& layers, const ProfileScalars& fits) {
  const double square = mean_over(layers, {fits.fit_bottom, fits.fit_top}, [&](const Of& layer) {
    return std::pow(layer.v_x - fits.shear_rate * (layer.z + fits.H), 2);
  });
  return std::sqrt(square) / fits.surface_speed;
}

/// Largest mean of k over five neighbouring layers of a zone, and I in the middle of them. One layer alone
/// would be the largest of its errors.
struct Largest {
  double value = Of::none, I = Of::none;
};
Largest largest_k(const Layers& at, Zone zone) {
  Largest found;
  for (std::size_t l = 2; l + 2 < at.size(); ++l) {
    if (!(at[l - 2].z >= zone.bottom) || !(at[l + 2].z <= zone.top)) continue;
    const double mean = (at[l - 2].k + at[l - 1].k + at[l].k + at[l + 1].k + at[l + 2].k) / 5;
    if (mean > found.value || !std::isfinite(found.value)) found = {mean, at[l].I};
  }
  return found;
}

/// Exponent p of a quantity over the shear rate ~ I^p: least squares through the logarithms, every layer
/// alike.
double power_of_I(const Layers& layers, Zone zone, double Of::*quantity, double I_min) {
  std::vector<double> log_I, log_ratio;
  for (const LayerValues& layer : layers) {
    if (!(layer.z >= zone.bottom && layer.z <= zone.top && layer.I >= I_min)) continue;
    const double ratio = std::log(layer.*quantity / layer.shear_rate);
    if (!std::isfinite(ratio)) continue;
    log_I.push_back(std::log(layer.I));
    log_ratio.push_back(ratio);
  }
  const auto line = log_I.size() < 3 ? std::nullopt : statistics::fit_line(log_I, log_ratio);
  return line ? line->slope : Of::none;
}

void add_gradient_scalars(const Layers& layers, Zone flowing, Zone still, Zone whole, ScalarSet& result) {
  const auto add = [&](const std::string& name, double value) {
    result.scalars.push_back({name, value, {}});
  };
  const double dk_dx = mean_over(layers, whole, &Of::d_k_dx);
  add("dk_dx", dk_dx);
  add("dk_dx_5", 10 * dk_dx);
  for (const auto& [name, slope] :
       {std::pair("dnu_dx", &Of::d_nu_dx), std::pair("dv_dx", &Of::d_v_x_dx),
        std::pair("dsigma_zz_dx", &Of::d_sigma_zz_dx), std::pair("dsigma_xx_dx", &Of::d_sigma_xx_dx),
        std::pair("dsigma_xz_dx", &Of::d_sigma_xz_dx)}) {
    add(std::string(name) + "_flowing", mean_over(layers, flowing, slope));
    add(std::string(name) + "_static", mean_over(layers, still, slope));
  }
}

/// The highest layer that is half as dense as the densest.
double top_of(const Layers& layers) {
  double densest = 0, top = Of::none;
  for (const LayerValues& layer : layers) densest = layer.nu > densest ? layer.nu : densest;
  for (const LayerValues& layer : layers)
    if (densest > 0 && layer.nu >= densest / 2) top = layer.z;
  return top;
}

}  // namespace

ScalarSet packing_scalars(const Profile& profile, const ProfilePlace& place,
                          const MeasurementOptions& options) {
  const Layers& layers = profile.layers;
  const ProfileScalars fits = profile_scalars(table_of(profile), options.scalars);
  // The flowing layer: the layers of the straight line without the loose one at the surface.
  const Zone flowing{fits.fit_bottom, -options.scalars.surface_speed_depth};
  const double wall = place.wall_z + options.wall_margin, I_min = options.fluctuation_I_min;
  const Zone still{wall, -fits.H - options.scalars.decay_to}, creeping{wall, -fits.H};
  const Zone decay{-fits.H - options.scalars.decay_from, -fits.H - options.scalars.decay_to};
  const double margin = place.closed ? 0 : options.bulk_margin;
  const Zone bulk{place.wall_z + margin, -margin};
  const double nu_bulk = mean_over(layers, bulk, &Of::nu), weight = mean_over(layers, bulk, &Of::density);
  const auto over_weight = [&](double Of::*stress, Zone zone, double share) {
    zone.top = std::min(zone.top, -2.0);  // above it the surface's own width is most of the weight
    return mean_over(layers, zone,
                     [&](const Of& layer) { return layer.*stress / (-layer.z * weight * share); });
  };
  const auto spin_over = [&](double factor, Zone zone, double Of::*rate) {
    return factor * mean_over(layers, zone, &Of::omega) / mean_over(layers, zone, rate);
  };
  const double cosine = std::cos(place.frame_angle), sine = std::sin(place.frame_angle);
  const Largest k = largest_k(layers, creeping);
  const auto with_ends = [&](double value) { return place.closed ? Of::none : value; };  // surface and wall
  ScalarSet result = scalars_of(
      {{"Q", fits.Q},
       {"H", fits.H},
       {"lambda", fits.lambda},
       {"shear_rate", fits.shear_rate},
       {"surface_speed", fits.surface_speed},
       {"line_misfit", line_misfit(layers, fits)},
       {"layer_balance", 0.4 * fits.shear_rate * fits.H * fits.H / fits.Q},
       {"I_th", fits.I_th},
       {"nu_bulk", nu_bulk},
       {"nu_surface_width", with_ends(height_of(layers, 0.05 * nu_bulk) - height_of(layers, 0.95 * nu_bulk))},
       {"nu_wall_width", with_ends(wall_width(layers, place.wall_z, 0.95 * nu_bulk))},
       {"spin_over_half_vorticity", spin_over(2, flowing, &Of::shear_rate)},
       {"spin_over_half_curl", spin_over(1, flowing, &Of::half_vorticity)},
       {"spin_over_half_vorticity_static", spin_over(2, decay, &Of::shear_rate)},
       {"sigma_zz_over_weight_flowing", over_weight(&Of::sigma_zz, flowing, cosine)},
       {"sigma_zz_over_weight_static", over_weight(&Of::sigma_zz, still, cosine)},
       {"sigma_xz_over_weight_flowing", over_weight(&Of::sigma_xz, flowing, sine)},
       {"sigma_xz_over_weight_static", over_weight(&Of::sigma_xz, still, sine)},
       {"dv_over_shear", mean_of_ratio(layers, flowing, &Of::dv, &Of::shear_rate)},
       {"domega_over_shear", mean_of_ratio(layers, flowing, &Of::domega, &Of::shear_rate)},
       {"dv_exponent", power_of_I(layers, creeping, &Of::dv, I_min)},
       {"domega_exponent", power_of_I(layers, creeping, &Of::domega, I_min)},
       {"k_flowing", mean_over(layers, flowing, &Of::k)},
       {"k_maximum", k.value},
       {"I_at_k_maximum", k.I},
       {"k_boundary", with_ends(mean_over(layers, {wall, wall + 5}, &Of::k))},
       {"coordination_flowing", mean_over(layers, flowing, &Of::coordination)},
       {"coordination_static", mean_over(layers, still, &Of::coordination)}});
  if (profile.known.gradients) add_gradient_scalars(layers, flowing, still, {wall, -2}, result);
  return result;
}

ScalarSet bulk_scalars(const Profile& profile, double wall_z, double margin, bool closed) {
  const Layers& layers = profile.layers;
  const Zone bulk{wall_z + (closed ? 0 : margin), closed ? 0 : top_of(layers) - margin};
  const double rate = mean_over(layers, bulk, &Of::shear_rate);
  const LayerStress sigma{mean_over(layers, bulk, &Of::sigma_xx), mean_over(layers, bulk, &Of::sigma_zz),
                          mean_over(layers, bulk, &Of::sigma_xz)};
  const LayerRatios ratios = layer_ratios(sigma, rate);
  return scalars_of({{"bulk_nu", mean_over(layers, bulk, &Of::nu)},
                     {"bulk_shear_rate", rate},
                     {"bulk_sigma_zz", sigma.zz},
                     {"bulk_sigma_xz", sigma.xz},
                     {"bulk_mu", ratios.mu},
                     {"bulk_I", ratios.I}});
}

bool belongs_to_a_drum(const std::string& name) {
  static constexpr std::array<std::string_view, 7> names{"theta_deg", "theta_com_deg", "Q_expected", "H",
                                                         "lambda",    "line_misfit",   "k_boundary"};
  return std::find(names.begin(), names.end(), name) != names.end() || name.ends_with("_static") ||
         name.ends_with("_flowing") || name.find("_dx") != std::string::npos;
}

}  // namespace drumlin::particles
