#include "particles/measurement/packing_scalars.hpp"

#include <cmath>
#include <string>

#include "coupling/exchange/profile_scalars.hpp"

namespace drumlin {
namespace {

constexpr double none = ProfileScalars::none;

/// Mean of value(layer) over the layers from `bottom` to `top`; NaN when there is none or one of them is NaN.
template <class Value>
double layer_mean(const ProfileSet& profiles, double bottom, double top, Value value) {
  if (!std::isfinite(bottom) || !std::isfinite(top)) return none;
  double sum = 0, count = 0;
  for (std::size_t l = 0; l < profiles.z.size(); ++l) {
    if (profiles.z[l] < bottom || profiles.z[l] > top) continue;
    sum += value(l);
    count += 1;
  }
  return count > 0 ? sum / count : none;
}

}  // namespace

ScalarSet packing_scalars(const ProfileSet& profiles, double wall_z, const MeasurementOptions& options) {
  const ProfileScalars fits = profile_scalars(profiles, options.scalars);
  // The flowing layer: the layers of the straight line without the loose one at the surface.
  const double bottom = fits.fit_bottom, top = -options.scalars.surface_speed_depth;
  const auto flowing_mean = [&](const std::string& name) {
    const ProfileColumn* column = profiles.find(name);
    return column ? layer_mean(profiles, bottom, top, [&](std::size_t l) { return column->value[l]; }) : none;
  };
  const auto flowing_ratio = [&](const std::string& name) {
    const ProfileColumn* column = profiles.find(name);
    const auto& rate = profiles.column("shear_rate").value;
    return column
               ? layer_mean(profiles, bottom, top, [&](std::size_t l) { return column->value[l] / rate[l]; })
               : none;
  };
  const auto& nu = profiles.column("nu").value;
  const double nu_bulk = layer_mean(profiles, wall_z + options.bulk_margin, -options.bulk_margin,
                                    [&](std::size_t l) { return nu[l]; });
  const double spin = flowing_mean("omega");
  return ScalarSet{{{"Q", fits.Q, {}},
                    {"H", fits.H, {}},
                    {"lambda", fits.lambda, {}},
                    {"shear_rate", fits.shear_rate, {}},
                    {"I_th", fits.I_th, {}},
                    {"nu_bulk", nu_bulk, {}},
                    {"spin_over_half_vorticity", 2 * spin / flowing_mean("shear_rate"), {}},
                    {"spin_over_half_curl", spin / flowing_mean("half_vorticity"), {}},
                    {"dv_over_shear", flowing_ratio("dv"), {}},
                    {"domega_over_shear", flowing_ratio("domega"), {}},
                    {"k_flowing", flowing_mean("k"), {}}}};
}

}  // namespace drumlin
