#pragma once
// The solver settings of a scene, as a step wants them.
#include "particles/scene/scene.hpp"
#include "particles/stepping/moreau_jean.hpp"

namespace drumlin::particles {

StepSolver solver_of(const Scene& scene, int threads, World* world = nullptr);

}  // namespace drumlin::particles
