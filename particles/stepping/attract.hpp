#pragma once
// Forces that pull surfaces together, before the contacts are solved.
#include "particles/effects/driven_walls.hpp"
#include "particles/stepping/step_contacts.hpp"

namespace drumlin::particles {

/// Lets the attraction c h of each pair act on grains and driven walls: q changes by W (-c h) through the
/// free velocities. `contacts.attraction` receives c h; it stays empty where no law of the scene attracts.
inline void attract(const StepInput& step, FreeMotion& free, StepContacts& contacts) {
  contacts.attraction.clear();
  each_law(step.laws, [&](const auto& law) {
    if constexpr (requires(const Candidate& pair) { law.attraction(pair, step.materials()); }) {
      contacts.attraction.resize(contacts.pairs.size());
      for (std::size_t a = 0; a < contacts.pairs.size(); ++a) {
        const Candidate& pair = contacts.pairs[a];
        const double pull = step.time_step * law.attraction(pair, step.materials());
        contacts.attraction[a] += pull;
        const double change = pull * step.inverse_mass()[pair.i];
        free.x[pair.i] -= change * pair.n_x, free.z[pair.i] -= change * pair.n_z;
        if (const std::int32_t k = driven_wall_of(step.walls, pair); k >= 0) {
          const Driven& wall = step.walls.driven[k];
          free.driven[k] += pull * wall.inverse_mass * normal_part(pair, wall.direction);
        }
        if (pair.j < 0) continue;
        const double back = pull * step.inverse_mass()[pair.j];
        free.x[pair.j] += back * pair.n_x, free.z[pair.j] += back * pair.n_z;
      }
    }
  });
}

}  // namespace drumlin::particles
