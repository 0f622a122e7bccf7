#include "particles/effects/gravity.hpp"

#include <cmath>
#include <numbers>

namespace drumlin::particles {

Point gravity_law(const Gravity& key, const Scales& scales) {
  const double unit = scales.length_m / (scales.time_s * scales.time_s);
  const double g = key.acceleration_m_s2 / unit;
  // Straight down in a plain scene: exactly (0, -g), no rounding of cos(-90 deg).
  if (key.direction_deg == -90) return {0, -g};
  const double direction = key.direction_deg * std::numbers::pi / 180;
  return {g * std::cos(direction), g * std::sin(direction)};
}

void set_free_motion(const Bodies& bodies, const std::optional<Point>& acceleration, double time_step,
                     const TeamLoops& loops, FreeMotion& free) {
  free.x.resize(bodies.count()), free.z.resize(bodies.count());
  const Point none{-0.0, -0.0};  // leaves a velocity of -0 alone, too
  const Point gain = acceleration ? Point{time_step * acceleration->x, time_step * acceleration->z} : none;
  loops.each(bodies.count(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      free.x[b] = bodies.v_x[b] + gain.x, free.z[b] = bodies.v_z[b] + gain.z;
  });
}

}  // namespace drumlin::particles
