#include "coupling/core/law/memory_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drumlin {

double inertial_number(const MemoryLaw& law, double rate, double p) {
  return 2 * rate / std::sqrt(p + (law.amount ? law.amount->own_weight : 0));
}

double memory_turn(double chi, double c, double I_low, double I_high, double ln_I) {
  const double low = std::log(I_low), high = std::log(I_high);
  const double share = std::clamp((ln_I - low) / (high - low), 0.0, 1.0);
  return chi + (std::atan(1 / c) - chi) * share * share * (3 - 2 * share);
}

double memory_turn(const MemoryLaw& law, double I) {
  return memory_turn(law.chi_deg * std::numbers::pi / 180, law.c, law.I_low, law.I_high, std::log(I));
}

double remembered_ln_I(const MemoryLaw& law, double I) {
  return std::log(std::clamp(I, law.mu.I.front(), law.mu.I.back()));
}

double dilatancy_target(const AmountMemory& law, double ln_I, double carried) {
  return law.swelling * law.c_nu * (ln_I - carried);
}

double axes_lag(const MemoryLaw& law, double turn, std::complex<double> n, std::complex<double> A, double I) {
  const double behind = std::atan(1 / law.c);
  return turn * (A * std::conj(n)).imag() - std::sin(memory_turn(law, I) - behind) * std::cos(behind);
}

double added_friction(const AmountMemory& law, double mu, double dilatancy, double axes_lag) {
  constexpr double most = 0.5;  // of mu
  return std::clamp(dilatancy - law.lag * axes_lag, -most * mu, most * mu);
}

double creep_friction(const Creep& creep, double rate, double spin) {
  return creep.slope * std::min(0.0, std::log(rate / (creep.ratio * std::abs(spin))));
}

double followed_slope(const AmountMemory& law) { return 0.5 * law.swelling * law.c_nu; }

TabulatedLaw memory_friction(const MemoryLaw& law) {
  const bool weighs = law.amount && law.amount->own_weight > 0;
  return {law.mu.I, law.mu.mu,
          weighs ? TabulatedLaw::Beyond::straight_in_I : TabulatedLaw::Beyond::straight_in_ln_I};
}

}  // namespace drumlin
