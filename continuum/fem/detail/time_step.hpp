#pragma once
// One step of the implicit Euler method on one mesh: what all flows in time share. Private to fem/.
#include "continuum/fem/detail/newton.hpp"

namespace drumlin::continuum::fem {

/// From the level's state, which is that of `inertia.before`, to the end of the step. From rest a fluid comes
/// first, then the law at smaller and smaller eps. False where Newton's method fails; the state is its last.
bool advance_once(Newton& newton, const FlowSolverOptions& options, const InertiaSetting& inertia,
                  SolvedLevel& level);

}  // namespace drumlin::continuum::fem
