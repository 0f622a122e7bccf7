#include "continuum/rheology/well_posedness.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin {

double well_posedness_margin(const Strength& F, double rate, double saturation) {
  const double m = saturation;
  if (m * std::abs(F.d_pressure) >= 1) return -1;  // pressure cannot balance the wave: no symbol at all
  const double r = rate * F.d_rate / F.value;
  const auto numerator = [&](double a) { return (1 - r) * a * a - F.d_pressure * a + 1 - (1 - r) * m * m; };
  double smallest = std::min(numerator(-m), numerator(m));
  if (r < 1) smallest = std::min(smallest, numerator(std::clamp(F.d_pressure / (2 * (1 - r)), -m, m)));
  return smallest;
}

}  // namespace drumlin
