#include "particles/scene/scene.hpp"

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

bool moves_walls_by_force(const Scene& scene) {
  for (const Stage& stage : scene.stages)
    for (const WallMotion& asked : stage.motions)
      if (std::holds_alternative<ForceControl>(asked.motion)) return true;
  return false;
}

}  // namespace drumlin::particles
