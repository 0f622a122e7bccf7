#include "continuum/reference/closed_forms.hpp"

#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "continuum/quadrature/integral.hpp"

namespace drumlin::continuum {
namespace {

// mu(I) of any friction law: at p = 1 the strength is mu and I is 2 |D|.
double friction_of(const StressLaw& law, double I) {
  assert(is_of_inertial_number(law));
  return strength(law, 0.5 * I, 1).value;
}

double incline_speed(double I, double nu, double theta, double height, double z) {
  return 2.0 / 3 * I * std::sqrt(nu * std::cos(theta)) * (std::pow(height, 1.5) - std::pow(height - z, 1.5));
}

// Depth at which mu = tan(theta) - kappa y/2 is used up: nothing moves below.
double drum_centre_depth(const DrumCentre& centre) {
  assert(centre.kappa > 0);
  return 2 * std::tan(centre.theta) / centre.kappa;
}

template <class Law>
double slope_of_flux(const Law& law, double nu, double kappa, double Q) {
  double low = 0, high = 0.499 * std::numbers::pi;  // the flux grows with the slope
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (drum_centre_flux(law, {nu, kappa, middle}) < Q ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

double inertial_number(const LogLaw& law, double mu) { return std::exp((mu - law.a) / law.b); }

double inertial_number(const StressLaw& law, double mu) {
  double low = -690, high = 690;  // ln I: the range of numbers
  if (friction_of(law, std::exp(low)) >= mu) return 0;
  if (friction_of(law, std::exp(high)) <= mu) return std::numeric_limits<double>::infinity();
  for (int i = 0; i < 64; ++i) {
    const double middle = 0.5 * (low + high);
    (friction_of(law, std::exp(middle)) < mu ? low : high) = middle;
  }
  return std::exp(0.5 * (low + high));
}

double bagnold_speed(const LogLaw& law, double nu, double theta, double height, double z) {
  return incline_speed(inertial_number(law, std::tan(theta)), nu, theta, height, z);
}

double bagnold_speed(const StressLaw& law, double nu, double theta, double height, double z) {
  return incline_speed(inertial_number(law, std::tan(theta)), nu, theta, height, z);
}

double plane_shear_rate(const LogLaw& law, double pressure, double shear_stress) {
  return inertial_number(law, shear_stress / pressure) * std::sqrt(pressure);
}

double plane_shear_rate(const StressLaw& law, double pressure, double shear_stress) {
  return inertial_number(law, shear_stress / pressure) * std::sqrt(pressure);
}

double vertical_chute_speed(const LogLaw& law, double nu, double pressure, double half_width, double y) {
  const double length = law.b * pressure / nu;
  // The exponents are joined before exp: each alone would leave the range of numbers for narrow b.
  return std::sqrt(pressure) * length *
         (std::exp(half_width / length - law.a / law.b) - std::exp(y / length - law.a / law.b));
}

double vertical_chute_speed(const StressLaw& law, double nu, double pressure, double half_width, double y) {
  return integral([&](double at) { return inertial_number(law, nu * at / pressure) * std::sqrt(pressure); },
                  y, half_width);
}

double drum_centre_rate(const StressLaw& law, const DrumCentre& centre, double y) {
  const double mu = std::tan(centre.theta) - 0.5 * centre.kappa * y;
  return inertial_number(law, mu) * std::sqrt(centre.nu * std::cos(centre.theta) * y);
}

double drum_centre_speed(const StressLaw& law, const DrumCentre& centre, double y) {
  return integral([&](double at) { return drum_centre_rate(law, centre, at); }, y, drum_centre_depth(centre));
}

double drum_centre_flux(const StressLaw& law, const DrumCentre& centre) {
  // The integral of the speed, by parts.
  return centre.nu * integral([&](double at) { return at * drum_centre_rate(law, centre, at); }, 0,
                              drum_centre_depth(centre));
}

double drum_centre_flux(const LogLaw& law, const DrumCentre& centre) {
  const double length = 2 * law.b / centre.kappa;
  return centre.nu * inertial_number(law, std::tan(centre.theta)) *
         std::sqrt(centre.nu * std::cos(centre.theta)) * std::pow(length, 2.5) * std::tgamma(2.5);
}

double drum_centre_slope(const LogLaw& law, double nu, double kappa, double Q) {
  return slope_of_flux(law, nu, kappa, Q);
}

double drum_centre_slope(const StressLaw& law, double nu, double kappa, double Q) {
  return slope_of_flux(law, nu, kappa, Q);
}

double annular_couette_speed(const LogLaw& law, double pressure, double inner_radius, double outer_radius,
                             double mu_i, double r) {
  const auto at = [&](double radius) {
    return std::expint(mu_i * inner_radius * inner_radius / (law.b * radius * radius));
  };
  return 0.5 * r * std::sqrt(pressure) * std::exp(-law.a / law.b) * (at(r) - at(outer_radius));
}

}  // namespace drumlin::continuum
