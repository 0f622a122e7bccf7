#pragma once
// Consistency checks of a scene: whether its parts fit together, which no single key can say of itself.
#include <string>
#include <vector>

#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// A contradiction. `about` names the keys that it rests on (a path stands for all below it): where one of
/// them is wrong by itself, the contradiction would only repeat that.
struct SceneFault {
  std::string key;  ///< path as in overrides, "stages.1.turns"
  std::string what;
  std::string allowed;
  std::vector<std::string> about;
};

/// All contradictions of a scene; empty for one that can be run. Reads the list of grains if there is one:
/// problems inside it carry their own place and are thrown as InputError by place_grains, not told here.
std::vector<SceneFault> validate(const Scene& scene);

}  // namespace drumlin::particles
