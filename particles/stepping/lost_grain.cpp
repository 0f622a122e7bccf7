#include "particles/stepping/lost_grain.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "particles/scene/longest_step.hpp"

namespace drumlin::particles {

std::string to_string(LostGrain::How how) {
  switch (how) {
    case LostGrain::How::left_container:
      return "left its container";
    case LostGrain::How::pushed_too_far:
      return "meets a wall that moves further than the grain's radius in a step (time_step_s is too large)";
    case LostGrain::How::went_through_wall:
      return "went through a wall";
    case LostGrain::How::not_finite:
      return "has a place or speed that is no finite number";
    case LostGrain::How::too_fast:
      return fmt::format("flies by more than {:g} d in a step (time_step_s is too large)", longest_flight);
  }
  return "is lost";
}

bool has_left(const Shape& wall, double radius, double gap) {
  return std::holds_alternative<Container>(wall) && !(gap >= -radius);
}

bool pushed_too_far(const Shape& wall, const Pose& step, Point grain, Point normal, double radius) {
  if (!std::holds_alternative<Segment>(wall) && !std::holds_alternative<Arc>(wall)) return false;
  const Point touched = grain - radius * normal;
  // Not a number either.
  return !(std::abs(dot(touched - moved(inverse(step), touched), normal)) <= radius);
}

std::optional<LostGrain> grain_that_is_not_finite(const Bodies& bodies) {
  const bool with_spin = !bodies.spin.empty();
  // One sum for all: it is finite only if every part is.
  const auto measure = [&](std::size_t b) {
    const double rim = with_spin ? bodies.radius[b] * bodies.spin[b] : 0;
    const Point v = velocity(bodies, b);
    return dot(v, v) + rim * rim + std::abs(bodies.x[b]) + std::abs(bodies.z[b]);
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

std::optional<LostGrain> grain_too_fast(const Bodies& bodies, double time_step) {
  const double speed = longest_flight / time_step, most = speed * speed;
  const auto square = [&](std::size_t b) { return dot(velocity(bodies, b), velocity(bodies, b)); };
  double fastest = 0;
  for (std::size_t b = 0; b < bodies.count(); ++b) fastest = std::max(fastest, square(b));
  if (!(fastest > most)) return std::nullopt;
  std::size_t b = 0;
  while (!(square(b) > most)) ++b;
  return LostGrain{static_cast<int>(b), bodies.x[b], bodies.z[b], LostGrain::How::too_fast};
}

}  // namespace drumlin::particles
