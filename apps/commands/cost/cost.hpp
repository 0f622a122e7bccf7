#pragma once
// The parts of `drumlin cost`, one for each kind of scene and question. Each returns an exit code.
#include "apps/support/commands.hpp"

namespace drumlin::apps {

/// The scene without and with each effect, one after the other.
int price_particle_effects(const CostOptions& options);
int price_flow_effects(const CostOptions& options);
/// Errors over seconds.
int sweep_particles(const CostOptions& options);
int sweep_flow(const CostOptions& options);

}  // namespace drumlin::apps
