#pragma once
// Terms of a flow problem that come from the law and the effects of a scene alone, in any geometry.
#include "continuum/model/flow_problem.hpp"
#include "continuum/model/flow_scene.hpp"
#include "coupling/core/law/rheology_fit.hpp"

namespace drumlin::continuum {

/// Sets mu(I), k(I) where the law has it, memory of the axes, nonlocal fluidity and inertia. Throws
/// InputError for an effect that the law does not allow: memory without its table or with k, nonlocal
/// fluidity where mu does not determine the fluidity or has no threshold. Its problems name keys of the scene
/// and no file.
void add_law_and_effects(const FlowScene& scene, const RheologyFit& law, FlowProblem& problem);

/// Throws InputError for a scene with an effect that needs a drum: rotating frame, slip along the wall, a
/// surface that moves.
void refuse_effects_of_the_drum(const FlowEffects& effects);

}  // namespace drumlin::continuum
