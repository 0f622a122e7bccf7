#pragma once
// Whether the materials of a scene and the pairs of its laws fit together.
#include <vector>

#include "particles/scene/validate.hpp"

namespace drumlin {

/// Appends what is wrong.
void check_materials(const Scene& scene, std::vector<SceneFault>& faults);

}  // namespace drumlin
