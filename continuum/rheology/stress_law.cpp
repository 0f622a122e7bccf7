#include "continuum/rheology/stress_law.hpp"

#include <cassert>
#include <cmath>

namespace drumlin {

template <class FrictionLaw>
Strength strength(const FrictionLaw& law, double rate, double pressure) {
  assert(rate > 0 && pressure > 0);
  const Friction f = law.friction(2 * rate / std::sqrt(pressure));
  return {f.mu * pressure, f.slope * pressure / rate, f.mu - 0.5 * f.slope};
}
template Strength strength(const LogLaw&, double, double);
template Strength strength(const LogLinearLaw&, double, double);
template Strength strength(const SaturatingLaw&, double, double);
template Strength strength(const ConstantLaw&, double, double);
template Strength strength(const TabulatedLaw&, double, double);

Strength strength(const NewtonianLaw& law, double rate, double /*pressure*/) {
  return {2 * law.viscosity * rate, 2 * law.viscosity, 0};
}

Strength strength(const StressLaw& law, double rate, double pressure) {
  return std::visit([&](const auto& chosen) { return strength(chosen, rate, pressure); }, law);
}

namespace {

// From what a file holds to what computes.
struct LawOfFile {
  StressLaw operator()(const LogFriction& mu) const { return LogLaw{mu.a, mu.b}; }
  StressLaw operator()(const LogLinearFriction& mu) const { return LogLinearLaw{mu.a, mu.b, mu.c}; }
  StressLaw operator()(const ConstantFriction& mu) const { return ConstantLaw{mu.mu}; }
  StressLaw operator()(const JopFriction& mu) const { return SaturatingLaw{mu.mu_s, mu.mu_2, mu.I_0}; }
  StressLaw operator()(const FrictionTable& mu) const { return TabulatedLaw(mu.I, mu.mu); }
};

}  // namespace

StressLaw stress_law(const RheologyFit& fit) { return std::visit(LawOfFile{}, fit.mu); }

}  // namespace drumlin
