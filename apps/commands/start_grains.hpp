#pragma once
// The grains with which a run starts where its scene names another run (grains.from_run).
#include <nlohmann/json_fwd.hpp>

#include "particles/scene/scene.hpp"

namespace drumlin::apps {

/// Replaces grains.from_run by a list: places, velocities, spins, densities and materials of the grains in a
/// snapshot. Returns which snapshot of which run it was, and what that run says of its own start: a chain;
/// null for other scenes. Impulses are not taken over. Throws InputError if the run has no such snapshot, or
/// materials that its snapshots do not tell.
nlohmann::ordered_json take_over_grains(particles::Scene& scene);

}  // namespace drumlin::apps
