#pragma once
// The state that all points of a sweep over a particle scene begin with.
#include "apps/support/commands.hpp"
#include "particles/accuracy/stretch.hpp"

namespace drumlin::apps {

/// The end of the run of `from`, or the beginning of the scene's last stage, up to which it is run; kept in
/// OUTPUT/start.h5. Throws InputError when the run is unfinished or of other grains, walls, effects.
particles::SweepStart sweep_start(const CostOptions& options, const particles::Scene& scene);

}  // namespace drumlin::apps
