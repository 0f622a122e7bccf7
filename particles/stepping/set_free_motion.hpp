#pragma once
// Velocities of the grains without contacts.
#include <algorithm>
#include <cstddef>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/free_motion.hpp"
#include "particles/effects/effects.hpp"
#include "particles/parallel/parallel_loops.hpp"

namespace drumlin::particles {

/// Their own velocities, and what the effects make of them within a step.
inline void set_free_motion(const Bodies& bodies, const EffectsOf<LawOf>& laws, double time_step,
                            const ParallelLoops& loops, FreeMotion& free) {
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

/// What the effects make of spins within a step without contacts.
inline void turn_freely(const EffectsOf<LawOf>& laws, double time_step, Bodies& bodies) {
  each_law(laws, [&](const auto& law) {
    if constexpr (requires { law.turn_freely(bodies, time_step); }) law.turn_freely(bodies, time_step);
  });
}

}  // namespace drumlin::particles
