#include "particles/effects/wall_step.hpp"

#include "particles/effects/driven_walls.hpp"

namespace drumlin::particles {

WallStep wall_step(const Walls& walls, double time_in_stage, double time_step,
                   std::span<const DrivenState> driven) {
  WallStep step;
  step.before = walls.shapes_at(time_in_stage, driven);
  step.after = walls.shapes_at(time_in_stage + time_step, driven);
  std::vector<Pose> moves;
  for (int wall = 0; wall < static_cast<int>(walls.names.size()); ++wall)
    moves.push_back(after(walls.pose(wall, time_in_stage + time_step, driven),
                          inverse(walls.pose(wall, time_in_stage, driven))));
  for (const int wall : walls.wall_of_shape) step.displacement.push_back(moves[wall]);
  add_driven_walls(walls, driven, time_in_stage, time_step, step);
  return step;
}

}  // namespace drumlin::particles
