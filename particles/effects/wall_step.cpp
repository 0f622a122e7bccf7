#include "particles/effects/wall_step.hpp"

#include "particles/effects/driven_walls.hpp"

namespace drumlin::particles {

namespace {

double surface_speed(const std::vector<Motion>& motions) {
  double speed = 0;
  for (const Motion& motion : motions)
    if (const auto* running = std::get_if<Running>(&motion)) speed += running->speed;
  return speed;
}

}  // namespace

std::vector<ShapeStep> resting_steps(const Walls& walls, std::span<const std::uint8_t> material_of_grain) {
  std::vector<ShapeStep> steps(walls.wall_of_shape.size());
  for (std::size_t s = 0; s < walls.acts_on.size(); ++s)
    steps[s].materials = &walls.acts_on[s], steps[s].material_of_grain = material_of_grain;
  return steps;
}

WallStep wall_step(const Walls& walls, double time_in_stage, double time_step,
                   std::span<const DrivenState> driven, std::span<const std::uint8_t> material_of_grain) {
  WallStep step;
  step.before = walls.shapes_at(time_in_stage, driven);
  step.after = walls.shapes_at(time_in_stage + time_step, driven);
  std::vector<Pose> moves;
  for (int wall = 0; wall < static_cast<int>(walls.names.size()); ++wall)
    moves.push_back(after(walls.pose(wall, time_in_stage + time_step, driven),
                          inverse(walls.pose(wall, time_in_stage, driven))));
  step.displacement = resting_steps(walls, material_of_grain);
  for (std::size_t s = 0; s < step.displacement.size(); ++s) {
    const int wall = walls.wall_of_shape[s];
    step.displacement[s].set_displacement(moves[wall]);
    step.displacement[s].surface = time_step * surface_speed(walls.motions[wall]);
  }
  add_driven_walls(walls, driven, time_step, step);
  return step;
}

}  // namespace drumlin::particles
