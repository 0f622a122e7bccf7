#pragma once
// A scene with one of its effects taken away, or one added that it does not name: what `drumlin cost
// --effects` prices.
#include <string>
#include <vector>

#include "coupling/core/basics/enum_names.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

enum class EffectChange { none, removed, added };
constexpr auto names_of(EffectChange) { return std::array{"none", "removed", "added"}; }

struct EffectVariant {
  std::string effect;  ///< as in docs/effects.md
  EffectChange change = EffectChange::none;
  std::string with_it;  ///< what goes with it because it cannot stay alone, or the strength that was added
  Scene scene;
  std::string refused;  ///< why the variant is no scene that can be run; empty for one that can
};

/// First the scene itself, then each of its effects removed, then each absent one added at a modest strength.
/// Effects that have no meaning in the scene (a rough wall where there is none) are left out.
std::vector<EffectVariant> effect_variants(const Scene& scene);

}  // namespace drumlin::particles
