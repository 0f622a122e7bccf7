#pragma once
// A finished scene whose last stage goes on for longer.
#include "particles/scene/scene.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::particles {

/// Makes the last stage longer by about `seconds`, at least by one interval between its snapshots: by a whole
/// number of steps of the very length that they had, and of intervals between snapshots. `state`, of the
/// finished run of `scene`, is then that of a run of the longer scene, to the last bit. Throws InputError if
/// the state is not finished, or if the longer scene would have done anything else up to now: the last stage
/// has `until`, a ramp of gravity, or intervals of snapshots shorter than the velocity window.
Scene prolonged(const Scene& scene, double seconds, SimulationState& state);

}  // namespace drumlin::particles
