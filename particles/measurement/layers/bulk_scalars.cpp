#include "particles/measurement/layers/bulk_scalars.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

namespace drumlin::particles {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Mean of a column over [bottom, top]; NaN without it, without a layer, or where one of them is not known.
double mean_over(const ProfileSet& profiles, const std::string& name, double bottom, double top) {
  const ProfileColumn* column = profiles.find(name);
  if (column == nullptr) return none;
  double sum = 0, layers = 0;
  for (std::size_t l = 0; l < profiles.z.size(); ++l) {
    if (profiles.z[l] < bottom || profiles.z[l] > top) continue;
    sum += column->value[l];
    layers += 1;
  }
  return layers > 0 ? sum / layers : none;
}

/// The highest layer that is half as dense as the densest.
double top_of(const ProfileSet& profiles) {
  const ProfileColumn* nu = profiles.find("nu");
  double densest = 0, top = none;
  if (nu == nullptr) return top;
  for (const double value : nu->value)
    if (value > densest) densest = value;
  for (std::size_t l = 0; l < profiles.z.size(); ++l)
    if (densest > 0 && nu->value[l] >= densest / 2) top = profiles.z[l];
  return top;
}

}  // namespace

ScalarSet bulk_scalars(const ProfileSet& profiles, double wall_z, double margin, bool closed) {
  const double bottom = wall_z + (closed ? 0 : margin), top = closed ? 0 : top_of(profiles) - margin;
  const auto mean = [&](const char* name) { return mean_over(profiles, name, bottom, top); };
  const double rate = mean("shear_rate"), normal = mean("sigma_zz"), shear = mean("sigma_xz");
  const double pressed = normal > 0 ? normal : none;
  return {{{"bulk_nu", mean("nu"), {}},
           {"bulk_shear_rate", rate, {}},
           {"bulk_sigma_zz", normal, {}},
           {"bulk_sigma_xz", shear, {}},
           {"bulk_mu", shear / pressed, {}},
           {"bulk_I", rate / std::sqrt(pressed), {}}}};
}

bool belongs_to_a_drum(const std::string& name) {
  static constexpr std::array<std::string_view, 7> names{"theta_deg", "theta_com_deg", "Q_expected", "H",
                                                         "lambda",    "line_misfit",   "k_boundary"};
  return std::find(names.begin(), names.end(), name) != names.end() || name.ends_with("_static") ||
         name.ends_with("_flowing") || name.find("_dx") != std::string::npos;
}

}  // namespace drumlin::particles
