#pragma once
// Picard iteration around Newton's method, for the fields that the law takes from the flow. Private to fem/.
#include "continuum/fem/detail/newton.hpp"

namespace drumlin::continuum::fem {

/// Lowers eps to the problem's own from that of the level's setting; where a step fails it is halved (in ln
/// eps) from the last solution that converged.
bool lower_shear_rate(Newton& newton, const FlowSolverOptions& options, double tolerance, SolvedLevel& level);

/// One Picard update solves for the held fields (held_fields.hpp) with the flow given, then for the flow with
/// the fields given; updates end where a whole one moves the flow by less than the tolerance. Starts with the
/// local flow without k, or with the fields that were held before. False: not converged, or interrupted; the
/// report says why.
bool solve_held_fields(Newton& newton, const FlowSolverOptions& options, SolvedLevel& level,
                       FlowReport& report);

}  // namespace drumlin::continuum::fem
