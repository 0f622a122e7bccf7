#include "continuum/reference/closed_forms.hpp"

#include <cmath>

namespace drumlin {

double inertial_number(const LogLaw& law, double mu) { return std::exp((mu - law.a) / law.b); }

double bagnold_speed(const LogLaw& law, double nu, double theta, double height, double z) {
  const double I = inertial_number(law, std::tan(theta));
  return 2.0 / 3 * I * std::sqrt(nu * std::cos(theta)) * (std::pow(height, 1.5) - std::pow(height - z, 1.5));
}

double plane_shear_rate(const LogLaw& law, double pressure, double shear_stress) {
  return inertial_number(law, shear_stress / pressure) * std::sqrt(pressure);
}

double vertical_chute_speed(const LogLaw& law, double nu, double pressure, double half_width, double y) {
  const double length = law.b * pressure / nu;
  // The exponents are joined before exp: each alone would leave the range of numbers for narrow b.
  return std::sqrt(pressure) * length *
         (std::exp(half_width / length - law.a / law.b) - std::exp(y / length - law.a / law.b));
}

}  // namespace drumlin
