#pragma once
// Grains that another run has left, as the start of a scene (grains.from_run).
#include <filesystem>

#include "particles/io/run_folder.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

struct GrainsTakenOver {
  RunFolder run;
  std::filesystem::path snapshot;
  double time_s = 0;  // of the snapshot
  ListedGrains grains;
};

/// Places, velocities, spins, densities and materials of the grains in the snapshot that a scene asks for;
/// impulses are not taken over. Throws InputError if the run has no such snapshot, or materials that its
/// snapshots do not tell.
GrainsTakenOver grains_of_run(const GrainsOfRun& requested);

}  // namespace drumlin::particles
