#include "continuum/rheology/stress_law.hpp"

namespace drumlin::continuum {

Strength strength(const NewtonianLaw& law, double rate, double /*pressure*/) {
  return {2 * law.viscosity * rate, 2 * law.viscosity, 0};
}

Strength strength(const StressLaw& law, double rate, double pressure) {
  return std::visit([&](const auto& chosen) { return strength(chosen, rate, pressure); }, law);
}

StressLaw stress_law(const RheologyFit& fit) {
  return std::visit([](const auto& chosen) { return StressLaw(chosen); }, friction_law(fit.mu));
}

}  // namespace drumlin::continuum
