#pragma once
// Velocities of the grains without contacts.
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

}  // namespace drumlin::particles
