#include "continuum/rheology/friction_law.hpp"

#include <cmath>

namespace drumlin {
namespace {

std::vector<double> logarithms(std::vector<double> values) {
  for (double& value : values) value = std::log(value);
  return values;
}

}  // namespace

Friction kept_positive(double mu, double slope) {
  constexpr double floor = 1e-3;
  const double root = std::sqrt(mu * mu + 4 * floor * floor);
  return {0.5 * (mu + root), 0.5 * slope * (1 + mu / root)};
}

Friction LogLaw::friction(double I) const { return kept_positive(a + b * std::log(I), b); }

Friction LogLinearLaw::friction(double I) const {
  return kept_positive(a + b * std::log(I) + c * I, b + c * I);
}

Friction SaturatingLaw::friction(double I) const {
  const double share = I / (I_0 + I);
  return {mu_s + (mu_2 - mu_s) * share, (mu_2 - mu_s) * share * I_0 / (I_0 + I)};
}

Friction ConstantLaw::friction(double /*I*/) const { return {mu, 0}; }

TabulatedLaw::TabulatedLaw(const std::vector<double>& I, std::vector<double> mu)
    : mu_of_ln_I_(logarithms(I), std::move(mu), MonotoneCubic::Outside::goes_on) {}

Friction TabulatedLaw::friction(double I) const {
  const CurvePoint at = mu_of_ln_I_.at(std::log(I));
  return kept_positive(at.value, at.slope);
}

}  // namespace drumlin
