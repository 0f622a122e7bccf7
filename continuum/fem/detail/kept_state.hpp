#pragma once
// Conversion between a stored FlowState and a state on a mesh. Private to fem/.
#include "continuum/fem/detail/solved_level.hpp"
#include "continuum/fem/flow_solver.hpp"
#include "continuum/fem/flow_state.hpp"

namespace drumlin::continuum::fem {

/// Collective; complete on every rank.
FlowState kept_state(const SolvedLevel& level);

/// What is said where no mesh of a problem fits a kept state.
inline constexpr const char* no_mesh_fits =
    "the state of the neighbouring flow lies on none of the meshes of this one: geometry, fill and mesh have "
    "to be the same, speed and law may differ";

/// Whether the mesh has exactly the cells of `kept`, each within a tenth of its size of where it was: then
/// their values are values on this mesh.
bool fits(const Discretisation& d, const FlowState& kept);

/// Refines up to the mesh that fits, and returns its number. Throws InputError when none of options.levels +
/// options.further_levels meshes does.
int refine_to(const FlowState& kept, const FlowSolverOptions& options, SolvedLevel& level);

/// The values of what fits as they are, theta too.
void lay_down(const FlowState& kept, SolvedLevel& level);

/// Takes over what fits. Velocities are scaled to the given velocities of this problem (slow flow at another
/// speed is nearly that), which then hold exactly.
void take_over(const FlowState& kept, SolvedLevel& level);

}  // namespace drumlin::continuum::fem
