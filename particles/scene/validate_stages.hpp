#pragma once
// The part of validate() that concerns what stages change, and when they end.
#include <vector>

#include "particles/scene/validate.hpp"

namespace drumlin::particles {

/// Adds a fault for each wall that is opened twice, moved after, or unknown; for gravity and coefficients of
/// effects that the scene does not name; for pressed and straining walls that lack what they need; for
/// polylines and arcs that are none.
void check_stage_changes(const Scene&, std::vector<SceneFault>&);

/// The strongest gravity of a stage, m/s2; 0 without gravity.
double strongest_gravity(const Scene&, std::size_t stage);

}  // namespace drumlin::particles
