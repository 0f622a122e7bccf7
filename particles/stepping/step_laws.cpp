#include "particles/stepping/step_laws.hpp"

#include <algorithm>
#include <cmath>

#include "particles/scene/materials.hpp"
#include "particles/scene/scene_walls.hpp"

namespace drumlin::particles {

StepLaws laws_of(const Scene& scene, const Scales& scales) {
  StepLaws laws;
  const Effects& effects = scene.effects;
  const auto materials = material_names(scene);
  if (effects.gravity) laws.gravity = gravity_law(*effects.gravity, scales);
  if (effects.friction) laws.friction = friction_law(*effects.friction, materials);
  if (effects.restitution)
    laws.restitution = restitution_law(*effects.restitution, materials,
                                       laws.gravity ? std::hypot(laws.gravity->x, laws.gravity->z) : 0);
  laws.spin = effects.spin;
  if (effects.rolling_resistance) laws.rolling = rolling_law(*effects.rolling_resistance, materials);
  if (effects.cohesion) laws.cohesion = cohesion_law(*effects.cohesion, materials);
  if (laws.cohesion) laws.detection_margin = std::max(laws.detection_margin, laws.cohesion->range);
  laws.energy_ledger = scene.output.energy_ledger;
  laws.driven_walls = moves_walls_by_force(scene) || presses_cell(scene);
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

StepLaws laws_in(const Scene& scene, const Scales& scales, const Stage& stage) {
  Scene now = scene;
  const auto replace = [](auto& effect, const auto& asked) {
    if (!asked) return;
    effect->grain_grain = asked->grain_grain, effect->grain_wall = asked->grain_wall;
    effect->pairs.clear();
  };
  replace(now.effects.friction, stage.friction);
  replace(now.effects.restitution, stage.restitution);
  replace(now.effects.rolling_resistance, stage.rolling_resistance);
  replace(now.effects.cohesion, stage.cohesion);
  return laws_of(now, scales);
}

void set_gravity(const Gravity& gravity, const Scales& scales, StepLaws& laws) {
  laws.gravity = gravity_law(gravity, scales);
  if (laws.restitution) laws.restitution->gravity = std::hypot(laws.gravity->x, laws.gravity->z);
}

}  // namespace drumlin::particles
