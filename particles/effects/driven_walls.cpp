#include "particles/effects/driven_walls.hpp"

#include <cmath>

namespace drumlin::particles {

Driven driven_law(const ForceControl& key, const Scales& scales, int state) {
  const double unit = 1e-3 / scales.velocity_m_s();
  const double length = std::hypot(key.direction[0], key.direction[1]);
  const double mass = scales.density_kg_m3 * scales.length_m * scales.length_m;
  const double force = mass * scales.length_m / (scales.time_s * scales.time_s);
  return {{key.direction[0] / length, key.direction[1] / length},
          key.force_n_m / force,
          mass / key.mass_kg_m,
          key.velocity_mm_s[0] * unit,
          key.velocity_mm_s[1] * unit,
          state};
}

namespace {

/// The force that acts on a driven wall over a step: a pressure times the length between two walls. `shapes`:
/// at the beginning of the step.
double force_in_step(const Driven& wall, std::span<const Shape> shapes) {
  if (wall.between[0] < 0) return wall.force;
  const Point a = middle_of(shapes[wall.between[0]]), b = middle_of(shapes[wall.between[1]]);
  return wall.force * std::abs((b.x - a.x) * wall.direction.z - (b.z - a.z) * wall.direction.x);
}

}  // namespace

void add_driven_walls(const Walls& walls, std::span<const DrivenState> states, double time_step,
                      WallStep& step) {
  std::vector<std::int32_t> driven_of_wall(walls.names.size(), -1);
  for (std::size_t w = 0; w < walls.names.size(); ++w)
    if (const Driven* driven = driven_motion(walls, w)) {
      driven_of_wall[w] = static_cast<std::int32_t>(step.driven.size());
      step.driven.push_back(*driven);
      step.driven.back().force = force_in_step(*driven, step.before);
    }
  if (step.driven.empty()) return;
  for (std::size_t s = 0; s < walls.wall_of_shape.size(); ++s) {
    const std::int32_t k = driven_of_wall[walls.wall_of_shape[s]];
    step.driven_of_shape.push_back(k);
    if (k < 0) continue;
    const Driven& wall = step.driven[k];
    const double displacement = time_step * free_velocity(wall, states[k], time_step);
    const Pose free{0, displacement * wall.direction.x, displacement * wall.direction.z};
    step.after[s] = moved(Rigid(free), step.after[s]);
    step.displacement[s].set_displacement(after(free, step.displacement[s]));
  }
}

namespace {

/// Moves the shapes of driven wall k at the end of a step by `displacement` along its direction.
void move_shapes(std::size_t k, double displacement, WallStep& walls) {
  const Point shift = along({}, walls.driven[k], displacement);
  for (std::size_t s = 0; s < walls.after.size(); ++s) {
    if (walls.driven_of_shape[s] != static_cast<std::int32_t>(k)) continue;
    walls.after[s] = moved(Rigid({0, shift.x, shift.z}), walls.after[s]);
    walls.displacement[s].x += shift.x, walls.displacement[s].z += shift.z;
  }
}

}  // namespace

void shift_driven_wall(std::size_t k, double displacement, WallStep& walls, DrivenState& state) {
  move_shapes(k, displacement, walls);
  state.position += displacement;
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
