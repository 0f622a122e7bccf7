#include "coupling/law/memory_law.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drumlin {

double memory_turn(const MemoryLaw& law, double I) {
  const double low = std::log(law.I_low), high = std::log(law.I_high);
  const double share = std::clamp((std::log(I) - low) / (high - low), 0.0, 1.0);
  const double chi = law.chi_deg * std::numbers::pi / 180;
  return chi + (std::atan(1 / law.c) - chi) * share * share * (3 - 2 * share);
}

TabulatedLaw memory_friction(const MemoryLaw& law) { return {law.mu.I, law.mu.mu}; }

}  // namespace drumlin
