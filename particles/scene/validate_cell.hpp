#pragma once
// Checks of the keys of a cell: a domain periodic in x and z, and how stages move it.
#include <vector>

#include "particles/scene/scene.hpp"
#include "particles/scene/validate.hpp"

namespace drumlin::particles {

/// Adds what is wrong with them.
void check_cell(const Scene& scene, std::vector<SceneFault>& faults);

}  // namespace drumlin::particles
