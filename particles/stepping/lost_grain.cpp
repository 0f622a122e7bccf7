#include "particles/stepping/lost_grain.hpp"

#include <cmath>

namespace drumlin::particles {

std::string to_string(LostGrain::How how) {
  return how == LostGrain::How::left_container ? "left its container"
                                               : "has a place or speed that is no finite number";
}

bool has_left(const Shape& wall, double radius, double gap) {
  return std::holds_alternative<Container>(wall) && gap < -radius;
}

std::optional<LostGrain> grain_that_is_not_finite(const Bodies& bodies) {
  const bool with_spin = !bodies.spin.empty();
  // One sum for all: it is finite only if every part is.
  const auto measure = [&](std::size_t b) {
    const double rim = with_spin ? bodies.radius[b] * bodies.spin[b] : 0;
    return bodies.v_x[b] * bodies.v_x[b] + bodies.v_z[b] * bodies.v_z[b] + rim * rim + std::abs(bodies.x[b]) +
           std::abs(bodies.z[b]);
  };
  double sum = 0;
  for (std::size_t b = 0; b < bodies.count(); ++b) sum += measure(b);
  if (std::isfinite(sum)) return std::nullopt;
  std::size_t worst = 0;  // where each is finite and only the sum is not, the fastest
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    if (!(measure(b) <= measure(worst))) worst = b;
    if (!std::isfinite(measure(b))) break;
  }
  return LostGrain{static_cast<int>(worst), bodies.x[worst], bodies.z[worst], LostGrain::How::not_finite};
}

}  // namespace drumlin::particles
