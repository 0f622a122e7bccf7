#pragma once
// Checks of where grains come from: regions, sizes, lists and groups.
#include <vector>

#include "particles/scene/validate.hpp"

namespace drumlin::particles {

void check_grains(const Scene& scene, std::vector<SceneFault>& faults);

}  // namespace drumlin::particles
