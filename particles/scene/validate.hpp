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

/// Relative; for comparisons of numbers that a user wrote to agree, and of lengths that may touch.
inline constexpr double relative_rounding = 1e-9;

/// Path of the table of wall w, and of stage s.
std::string wall_key(std::size_t w);
std::string stage_key(std::size_t s);

/// What an effect needs of the rest of a scene and does not find.
template <class E>
std::vector<SceneFault> faults_of(const E& effect, const Scene& scene) {
  std::vector<SceneFault> faults;
  const std::string key = std::string("effects.") + E::name;
  const auto refuse = [&](const std::string& what, const std::string& allowed, const std::string& with) {
    faults.push_back({key, what, allowed, {key, with}});
  };
  if constexpr (requires { effect.check(scene, refuse); }) effect.check(scene, refuse);
  return faults;
}

/// All contradictions of a scene; empty for one that can be run. Reads the list of grains if there is one:
/// problems inside it carry their own place and are thrown as InputError by place_grains, not told here.
std::vector<SceneFault> validate(const Scene& scene);

}  // namespace drumlin::particles
