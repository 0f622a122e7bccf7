#pragma once
// Velocities of the grains without contacts, and their ways with them.
#include <cstddef>
#include <optional>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/free_motion.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/parallel/team_loops.hpp"

namespace drumlin::particles {

/// Their own velocities, and what an acceleration gives within a step.
inline void set_free_motion(const Bodies& bodies, const std::optional<Point>& acceleration, double time_step,
                            const TeamLoops& loops, FreeMotion& free) {
  free.x.resize(bodies.count()), free.z.resize(bodies.count());
  const Point none{-0.0, -0.0};  // leaves a velocity of -0 alone, too
  const Point gain = acceleration ? Point{time_step * acceleration->x, time_step * acceleration->z} : none;
  loops.each(bodies.count(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b)
      free.x[b] = bodies.v_x[b] + gain.x, free.z[b] = bodies.v_z[b] + gain.z;
  });
}

/// Way of grain b within a step h, from its velocity after impacts to the one at the end: with the latter
/// where contacts act, which leaves no overlap; with the mean where none does, which is exact.
inline Point way_within_step(const FreeMotion& free, std::size_t b, Point before, Point after, bool loaded,
                             double h) {
  const Point v = loaded ? after : Point{(before.x + after.x) / 2, (before.z + after.z) / 2};
  if (free.shift.empty()) return {h * v.x, h * v.z};
  return {free.shift[b].x + h * v.x, free.shift[b].z + h * v.z};
}

}  // namespace drumlin::particles
