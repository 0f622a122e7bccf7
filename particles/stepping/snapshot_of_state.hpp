#pragma once
// A snapshot of the state of a simulation, but for its contacts, which only the engine knows.
#include <vector>

#include "particles/stepping/simulation.hpp"

namespace drumlin::particles {

/// What a state belongs to.
struct StateInScene {
  const Scene& scene;
  const Scales& scales;
  const TimePlan& plan;
  const Walls& walls;
  Period period;
  Point gravity;            ///< of the moment, as the scene tells directions
  bool own_masses = false;  ///< masses are stored even if no grain of the state has one of its own
};

/// Takes away the marks of the state that are used up.
Snapshot snapshot_of(const StateInScene& in, SimulationState& state);

/// Contacts sorted by their bodies; impulses of the same pair, impacts among them, are added up.
std::vector<SnapshotContact> one_for_each_pair(std::vector<SnapshotContact> contacts);

}  // namespace drumlin::particles
