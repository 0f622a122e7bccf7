#include "particles/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drumlin::particles {
double duration_s(const Stage& stage) {
  if (stage.duration_s) return *stage.duration_s;
  for (const auto& motion : stage.motions)
    if (const auto* rotation = std::get_if<Rotation>(&motion.motion); rotation && stage.turns)
      return *stage.turns * 60 / std::abs(rotation->speed_rpm);
  return std::numeric_limits<double>::quiet_NaN();
}

double steps_of(const Stage& stage) {
  const double steps = duration_s(stage) / stage.time_step_s, nearest = std::round(steps);
  return nearest >= 1 && steps > 1.01 * nearest ? nearest + 1 : nearest;
}

bool moves_walls_by_force(const Scene& scene) {
  return any_stage(scene, [](const Stage& stage) {
    return std::any_of(stage.motions.begin(), stage.motions.end(), is_driven);
  });
}

bool is_driven(const WallMotion& wall_motion) {
  return std::holds_alternative<ForceControl>(wall_motion.motion) ||
         std::holds_alternative<PressureControl>(wall_motion.motion);
}

bool ends_stages_early(const Scene& scene) {
  return any_stage(scene, [](const Stage& stage) { return stage.until.has_value(); });
}

bool opens_walls(const Scene& scene) {
  return any_stage(scene, [](const Stage& stage) { return stage.opens.has_value(); });
}

bool changes_gravity(const Scene& scene) {
  return any_stage(scene, [](const Stage& stage) { return stage.gravity.has_value(); });
}

bool changes_coefficients(const Stage& stage) {
  bool any = false;
  each_effect(
      [&any](const auto& values) {
        if constexpr (requires { values.has_value(); }) any = any || values.has_value();
      },
      stage.effects);
  return any;
}

bool moves_cell(const Scene& scene) {
  return any_stage(scene, [](const Stage& stage) { return stage.cell.has_value(); });
}

bool presses_cell(const Scene& scene) {
  const auto pressed = [](const std::optional<CellAxis>& axis) { return axis && axis->pressure_n_m2; };
  return any_stage(scene, [&](const Stage& stage) {
    return stage.cell && (pressed(stage.cell->xx) || pressed(stage.cell->zz));
  });
}

bool changes_grains(const Scene& scene) { return !scene.outlets.empty() || !scene.sources.empty(); }

std::vector<ListedGrains*> lists_of(Scene& scene) {
  std::vector<ListedGrains*> lists;
  if (auto* list = std::get_if<ListedGrains>(&scene.grains.source)) lists.push_back(list);
  for (GrainGroup& group : scene.grains.groups)
    if (auto* list = std::get_if<ListedGrains>(&group.source)) lists.push_back(list);
  return lists;
}

}  // namespace drumlin::particles
