#pragma once
// Consistency checks of materials and of the pairs in the laws of a scene.
#include <vector>

#include "particles/scene/validate.hpp"

namespace drumlin::particles {

/// Appends what is wrong.
void check_materials(const Scene& scene, std::vector<SceneFault>& faults);

}  // namespace drumlin::particles
