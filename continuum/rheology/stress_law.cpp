#include "continuum/rheology/stress_law.hpp"

#include <cassert>
#include <cmath>

#include "coupling/exchange/errors.hpp"

namespace drumlin {

Friction LogLaw::friction(double I) const {
  constexpr double floor = 1e-3;
  const double raw = a + b * std::log(I);
  const double root = std::sqrt(raw * raw + 4 * floor * floor);
  return {0.5 * (raw + root), 0.5 * b * (1 + raw / root)};
}

Friction SaturatingLaw::friction(double I) const {
  const double share = I / (I_0 + I);
  return {mu_s + (mu_2 - mu_s) * share, (mu_2 - mu_s) * share * I_0 / (I_0 + I)};
}

template <class FrictionLaw>
Strength strength(const FrictionLaw& law, double rate, double pressure) {
  assert(rate > 0 && pressure > 0);
  const Friction f = law.friction(2 * rate / std::sqrt(pressure));
  return {f.mu * pressure, f.slope * pressure / rate, f.mu - 0.5 * f.slope};
}
template Strength strength(const LogLaw&, double, double);
template Strength strength(const SaturatingLaw&, double, double);

Strength strength(const NewtonianLaw& law, double rate, double /*pressure*/) {
  return {2 * law.viscosity * rate, 2 * law.viscosity, 0};
}

Strength strength(const StressLaw& law, double rate, double pressure) {
  return std::visit([&](const auto& chosen) { return strength(chosen, rate, pressure); }, law);
}

StressLaw stress_law(const RheologyFit& fit, const std::string& file) {
  if (fit.k)
    throw InputError({InputProblem{
        .file = file,
        .key = "k",
        .what = "is given, but the continuum solves the law with k absent (sigma_xx = sigma_zz in "
                "simple shear)",
        .allowed = "a file without the table [k]"}});
  return LogLaw{fit.mu.a, fit.mu.b};
}

}  // namespace drumlin
