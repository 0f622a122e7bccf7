#pragma once
// Which scenes ranks can run.
#include <vector>

#include "coupling/common/errors.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// Why ranks cannot run a scene, key by key; empty: they can.
std::vector<InputProblem> not_on_ranks(const Scene& scene);

}  // namespace drumlin::particles
