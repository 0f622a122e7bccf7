#include "particles/stepping/step_laws.hpp"

#include <algorithm>

#include "particles/scene/materials.hpp"
#include "particles/scene/scene_walls.hpp"

namespace drumlin::particles {

StepLaws laws_of(const Scene& scene, const Scales& scales) {
  StepLaws laws;
  const auto materials = material_names(scene);
  const LawInput in{scales, materials};
  each_effect(
      [&in](const auto& effect, auto& law) {
        if (effect) law = law_of(*effect, in);
      },
      scene.effects, laws);
  each_law(laws, [&laws](const auto& law) {
    if constexpr (requires { law.range; }) laws.detection_margin = std::max(laws.detection_margin, law.range);
  });
  laws.contact_law = contact_law_of(scene.effects);
  laws.energy_ledger = scene.output.energy_ledger;
  laws.material_of_shape = walls_of(scene, scales).material_of_shape;
  if (scene.periodic_x) {
    const double unit = 1e-3 / scales.length_m;
    laws.period = {scene.periodic_x->x_min_mm * unit,
                   (scene.periodic_x->x_max_mm - scene.periodic_x->x_min_mm) * unit};
    if (const auto& z = scene.periodic_z) {
      laws.period.origin_z = z->z_min_mm * unit;
      laws.period.length_z = (z->z_max_mm - z->z_min_mm) * unit;
    }
  }
  return laws;
}

}  // namespace drumlin::particles
