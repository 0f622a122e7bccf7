#include "continuum/rheology/stress_law.hpp"

namespace drumlin::continuum {

Strength strength(const StressLaw& law, double rate, double pressure) {
  return std::visit([&](const auto& chosen) { return strength(chosen, rate, pressure); }, law);
}

StressLaw stress_law(const RheologyFit& fit) {
  return std::visit([](const auto& chosen) { return StressLaw(chosen); }, fit.mu);
}

}  // namespace drumlin::continuum
