#pragma once
// Laws of a step, dimensionless: those of the effects that a scene names, and where they act.
#include <cstdint>
#include <vector>

#include "particles/detection/cell_grid.hpp"
#include "particles/effects/effects.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// Those that the scene does not name are empty optionals.
struct StepLaws : EffectsOf<LawOf> {
  ContactLaw contact_law;
  bool energy_ledger = false;
  Period period;
  std::vector<std::uint8_t> material_of_shape;  ///< empty when no law asks for it
  double detection_margin = 0.02;               ///< d; pairs closer than this are always candidates
};

/// The laws of a scene.
StepLaws laws_of(const Scene& scene, const Scales& scales);

}  // namespace drumlin::particles
