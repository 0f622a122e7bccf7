// From the effects that a scene names to the laws of a step: the one place where their units go.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "particles/scene/materials.hpp"
#include "particles/stepping/moreau_jean.hpp"

namespace drumlin {
namespace {

/// `unit` turns the values of the scene into those of the simulation.
template <class Effect>
PairLaw pair_law(const Effect& effect, const std::vector<std::string>& materials, double unit = 1) {
  if (effect.pairs.empty()) return PerPair{effect.grain_grain * unit, effect.grain_wall * unit};
  const int count = static_cast<int>(materials.size()) + 1;  // the last: without a material
  const auto entries = static_cast<std::size_t>(count) * count;
  PerMaterials table{count, std::vector<double>(entries, effect.grain_grain * unit),
                     std::vector<double>(entries, effect.grain_wall * unit)};
  for (const auto& pair : effect.pairs) {
    const int a = material_number(materials, pair.between[0]),
              b = material_number(materials, pair.between[1]);
    for (const std::size_t entry :
         {static_cast<std::size_t>(a) * count + b, static_cast<std::size_t>(b) * count + a})
      table.grain_grain[entry] = table.grain_wall[entry] = pair.value * unit;
  }
  return table;
}

StepLaws::Acceleration gravity_of(const Gravity& gravity, const Scales& scales) {
  const double unit = scales.length_m / (scales.time_s * scales.time_s);
  const double g = gravity.acceleration_m_s2 / unit;
  // Straight down in a plain scene: exactly (0, -g), no rounding of cos(-90 deg).
  if (gravity.direction_deg == -90) return {0, -g};
  const double direction = gravity.direction_deg * std::numbers::pi / 180;
  return {g * std::cos(direction), g * std::sin(direction)};
}

}  // namespace

StepLaws laws_of(const Scene& scene, const Scales& scales) {
  StepLaws laws;
  const Effects& effects = scene.effects;
  const auto materials = material_names(scene);
  if (effects.gravity) laws.gravity = gravity_of(*effects.gravity, scales);
  if (effects.friction) laws.friction = pair_law(*effects.friction, materials);
  if (effects.restitution)
    laws.restitution = {pair_law(*effects.restitution, materials),
                        laws.gravity ? std::hypot(laws.gravity->x, laws.gravity->z) : 0};
  if (effects.rolling_resistance) laws.rolling = pair_law(*effects.rolling_resistance, materials);
  if (effects.cohesion)  // unit: the weight of a disc of diameter 1 and density 1 in gravity 1
    laws.cohesion = {pair_law(*effects.cohesion, materials, std::numbers::pi / 4), effects.cohesion->range_d};
  if (laws.cohesion) laws.detection_margin = std::max(laws.detection_margin, laws.cohesion->range);
  laws.spin = effects.spin.has_value();
  laws.energy_ledger = scene.output.energy_ledger;
  for (const Stage& stage : scene.stages)
    for (const WallMotion& motion : stage.motions)
      laws.driven_walls = laws.driven_walls || std::holds_alternative<ForceControl>(motion.motion);
  laws.material_of_shape = walls_of(scene, scales).material_of_shape;
  if (scene.periodic_x) {
    const double unit = 1e-3 / scales.length_m;
    laws.period = {scene.periodic_x->x_min_mm * unit,
                   (scene.periodic_x->x_max_mm - scene.periodic_x->x_min_mm) * unit};
  }
  return laws;
}

}  // namespace drumlin
