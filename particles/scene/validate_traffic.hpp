#pragma once
// Checks of outlets and sources, and of stages that wait for an outlet.
#include <vector>

#include "particles/scene/validate.hpp"

namespace drumlin::particles {

void check_traffic(const Scene& scene, std::vector<SceneFault>& faults);

}  // namespace drumlin::particles
