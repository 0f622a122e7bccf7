#include "particles/effects/driven_walls.hpp"

#include <cmath>

namespace drumlin::particles {

Driven driven_law(const ForceControl& key, const Scales& scales, int state) {
  const double unit = 1e-3 / scales.velocity_m_s();
  const double length = std::hypot(key.direction[0], key.direction[1]);
  const double mass = scales.density_kg_m3 * scales.length_m * scales.length_m;
  const double force = mass * scales.length_m / (scales.time_s * scales.time_s);
  return Driven{{key.direction[0] / length, key.direction[1] / length},
                key.force_n_m / force,
                mass / key.mass_kg_m,
                key.velocity_mm_s[0] * unit,
                key.velocity_mm_s[1] * unit,
                state};
}

void add_driven_walls(const Walls& walls, std::span<const DrivenState> states, double time_step,
                      WallStep& step) {
  std::vector<std::int32_t> driven_of_wall(walls.names.size(), -1);
  for (std::size_t w = 0; w < walls.names.size(); ++w)
    if (const auto* driven = std::get_if<Driven>(&walls.motion[w])) {
      driven_of_wall[w] = static_cast<std::int32_t>(step.driven.size());
      step.driven.push_back(*driven);
    }
  if (step.driven.empty()) return;
  for (std::size_t s = 0; s < walls.wall_of_shape.size(); ++s) {
    const std::int32_t k = driven_of_wall[walls.wall_of_shape[s]];
    step.driven_of_shape.push_back(k);
    if (k < 0) continue;
    const Driven& wall = step.driven[k];
    const double way = time_step * free_velocity(wall, states[k], time_step);
    const Pose free{0, way * wall.direction.x, way * wall.direction.z};
    step.after[s] = moved(Rigid(free), step.after[s]);
    step.displacement[s] = after(free, step.displacement[s]);
  }
}

namespace {

/// Moves the shapes of driven wall k at the end of a step by `way` along its direction.
void move_shapes(std::size_t k, double way, WallStep& walls) {
  const Point shift = along({}, walls.driven[k], way);
  for (std::size_t s = 0; s < walls.after.size(); ++s) {
    if (walls.driven_of_shape[s] != static_cast<std::int32_t>(k)) continue;
    walls.after[s] = moved(Rigid({0, shift.x, shift.z}), walls.after[s]);
    walls.displacement[s].x += shift.x, walls.displacement[s].z += shift.z;
  }
}

}  // namespace

void shift_driven_wall(std::size_t k, double way, WallStep& walls, DrivenState& state) {
  move_shapes(k, way, walls);
  state.position += way;
}

void move_driven_walls(const FreeMotion& motion, double time_step, WallStep& walls,
                       std::span<DrivenState> states) {
  for (std::size_t k = 0; k < walls.driven.size(); ++k) {
    const double without = free_velocity(walls.driven[k], states[k], time_step);
    move_shapes(k, time_step * (motion.driven[k] - without), walls);
    states[k].velocity = motion.driven[k];
    states[k].position += time_step * motion.driven[k];
  }
}

}  // namespace drumlin::particles
