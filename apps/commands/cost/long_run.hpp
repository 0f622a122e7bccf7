#pragma once
// A run long enough to be measured, from the state of a sweep.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "apps/commands/cost/particle_points.hpp"

namespace drumlin::apps {

/// Runs the last stage of `scene` from the state into FOLDER and measures it, by the code of `drumlin run`
/// and `drumlin measure`: an interrupted one goes on from its checkpoint. Returns a point with "statistics":
/// cpu_seconds, sweeps per step, and every scalar with its interval. What the run leaves is removed; throws
/// Interrupted.
nlohmann::ordered_json long_run(const particles::SweepStart& start, particles::Scene scene,
                                const std::filesystem::path& folder, int threads);

}  // namespace drumlin::apps
