#include "coupling/law/memory_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drumlin {

double memory_turn(double chi, double c, double I_low, double I_high, double ln_I) {
  const double low = std::log(I_low), high = std::log(I_high);
  const double share = std::clamp((ln_I - low) / (high - low), 0.0, 1.0);
  return chi + (std::atan(1 / c) - chi) * share * share * (3 - 2 * share);
}

double memory_turn(const MemoryLaw& law, double I) {
  return memory_turn(law.chi_deg * std::numbers::pi / 180, law.c, law.I_low, law.I_high, std::log(I));
}

TabulatedLaw memory_friction(const MemoryLaw& law) { return {law.mu.I, law.mu.mu}; }

}  // namespace drumlin
