#pragma once
// Finds grains that a run must not go on with: outside their container, or no longer numbers.
#include <optional>
#include <string>

#include "particles/bodies/vectors.hpp"

namespace drumlin::particles {

struct LostGrain {
  enum class How { left_container, pushed_too_far, went_through_wall, not_finite, too_fast };
  int grain = 0;
  double x = 0, z = 0;  ///< of its centre, d; not finite where that is what is wrong
  How how = How::not_finite;
};
std::string to_string(LostGrain::How);

/// Whether the centre of a grain with that gap to a wall stands outside a container. (What carries it through
/// a wall is undone as far as it can be: wall_crossing.hpp.)
bool has_left(const Shape& wall, double radius, double gap);

/// Whether a segment that pushes a grain moves further than the grain's radius along the normal within a
/// step: then the side on which the grain stands is no longer sure.
bool pushed_too_far(const Shape& wall, const Pose& step, Point grain, Point normal, double radius);

/// The first grain whose position or kinetic energy is not finite.
std::optional<LostGrain> grain_that_is_not_finite(const Bodies&);

/// The first grain that flies further than longest_flight within a step.
std::optional<LostGrain> grain_too_fast(const Bodies&, double time_step);

}  // namespace drumlin::particles
