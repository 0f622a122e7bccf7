#pragma once
// What an effect of a particle scene takes in time, memory and unknowns, and what it leads to.
#include <cmath>
#include <functional>

#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// What a scene takes, and what it leads to: means over the second half of its steps, in SI.
struct EffectPrice {
  double cpu_seconds = 0, detection_seconds = 0, solver_seconds = 0;
  double bytes = 0;  ///< of the heap, by the simulation
  int unknowns_per_contact = 0, velocities_per_body = 0;
  double contacts = 0, sweeps = 0, missed = 0;  ///< per step; share of steps that missed the tolerance
  double kinetic_energy_J_kg = 0;
  double center_x_mm = 0, center_z_mm = 0;
  double slope_deg = std::nan("");  ///< of the centre of mass about the container's centre, against gravity
  double overlap_d = 0;
  double unknowns() const { return contacts * unknowns_per_contact; }
};

/// Runs the scene's first `seconds`. `after_step` may throw to end it.
EffectPrice price_of(const Scene& scene, double seconds, int threads,
                     const std::function<void()>& after_step);

}  // namespace drumlin::particles
