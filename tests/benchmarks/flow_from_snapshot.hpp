#pragma once
// The last stage of a scene, continued from a snapshot of one of its runs.
#include "particles/bodies/snapshot.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::benchmark {

/// The last stage of a scene alone, from its beginning, without snapshots.
particles::Scene last_stage_of(particles::Scene scene);

/// The beginning of `scene` with grains as in the snapshot; without impulses to start from. Throws InputError
/// for a snapshot of other grains.
particles::SimulationState state_at(const particles::Scene& scene, const particles::Snapshot& from);

}  // namespace drumlin::benchmark
