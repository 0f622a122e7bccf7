#include "particles/effects/gravity.hpp"

#include <cmath>
#include <numbers>

namespace drumlin::particles {

GravityLaw law_of(const Gravity& key, const LawInput& in) {
  const Scales& scales = in.scales;
  const double unit = scales.length_m / (scales.time_s * scales.time_s);
  const double g = key.acceleration_m_s2 / unit;
  // Straight down in a plain scene: exactly (0, -g), no rounding of cos(-90 deg).
  if (key.direction_deg == -90) return Point{0, -g};
  const double direction = key.direction_deg * std::numbers::pi / 180;
  return Point{g * std::cos(direction), g * std::sin(direction)};
}

}  // namespace drumlin::particles
