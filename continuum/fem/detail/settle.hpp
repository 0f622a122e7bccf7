#pragma once
// The loop around Newton's method for what the law takes from the flow and holds while Newton runs. Private
// to fem/.
#include "continuum/fem/detail/newton.hpp"

namespace drumlin::fem {

/// Lowers eps to the problem's own from that of the level's setting; where a step fails it is halved (in ln
/// eps) from the last solution that converged.
bool lower_shear_rate(Newton& newton, const FlowSolverOptions& options, double tolerance, SolvedLevel& level);

/// What the law holds of the flow (held_fields.hpp) from the flow, the flow with it, and so on until a whole
/// update moves the flow by less than the tolerance. Starts with the local flow without k, or with what was
/// held before.
bool settle_held(Newton& newton, const FlowSolverOptions& options, SolvedLevel& level, FlowReport& report);

}  // namespace drumlin::fem
