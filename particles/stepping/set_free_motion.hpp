#pragma once
// Velocities of the grains without contacts, and their displacements with them.
#include <algorithm>
#include <cstddef>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/free_motion.hpp"
#include "particles/effects/effects.hpp"
#include "particles/parallel/team_loops.hpp"

namespace drumlin::particles {

/// Their own velocities, and what the effects make of them within a step.
inline void set_free_motion(const Bodies& bodies, const EffectsOf<LawOf>& laws, double time_step,
                            const TeamLoops& loops, FreeMotion& free) {
  free.x.resize(bodies.count()), free.z.resize(bodies.count());
  each_law(laws, [&](const auto& law) {
    if constexpr (requires { law.changes_inertia; }) free.inverse_mass = bodies.inverse_mass;
  });
  loops.each(bodies.count(), [&](std::size_t begin, std::size_t end) {
    std::copy(bodies.v_x.begin() + begin, bodies.v_x.begin() + end, free.x.begin() + begin);
    std::copy(bodies.v_z.begin() + begin, bodies.v_z.begin() + end, free.z.begin() + begin);
    each_law(laws, [&](const auto& law) {
      if constexpr (requires { law.move_freely(bodies, begin, end, time_step, free); })
        law.move_freely(bodies, begin, end, time_step, free);
    });
  });
}

/// Displacement of grain b within a step h, from its velocity after impacts to the one at the end: with the
/// latter where contacts act, which leaves no overlap; with the mean where none does, which is exact.
inline Point displacement_within_step(const FreeMotion& free, std::size_t b, Point before, Point after,
                                      bool loaded, double h) {
  const Point v = loaded ? after : Point{(before.x + after.x) / 2, (before.z + after.z) / 2};
  if (free.shift.empty()) return {h * v.x, h * v.z};
  return {free.shift[b].x + h * v.x, free.shift[b].z + h * v.z};
}

/// What the effects make of spins within a step without contacts.
inline void turn_freely(const EffectsOf<LawOf>& laws, double time_step, Bodies& bodies) {
  each_law(laws, [&](const auto& law) {
    if constexpr (requires { law.turn_freely(bodies, time_step); }) law.turn_freely(bodies, time_step);
  });
}

}  // namespace drumlin::particles
