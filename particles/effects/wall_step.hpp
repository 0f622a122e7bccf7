#pragma once
// The walls over one time step.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/shape_step.hpp"

namespace drumlin::particles {

/// Shapes at the beginning and the end of a step, and the displacement of each in between. Where contacts
/// push walls, `after` and `displacement` are those without contacts until the step is done.
struct WallStep {
  std::vector<Shape> before, after;
  std::vector<ShapeStep> displacement;
  std::vector<Driven> driven = {};                 ///< of the current stage, in the order of the walls
  std::vector<std::int32_t> driven_of_shape = {};  ///< -1: not driven; empty if no shape is
};

/// The step from `time_in_stage` on. `driven`: state of each wall that the stage drives, in their order.
/// `material_of_grain`, as long as the step lives: needed where walls act on some materials alone.
WallStep wall_step(const Walls& walls, double time_in_stage, double time_step,
                   std::span<const DrivenState> driven = {},
                   std::span<const std::uint8_t> material_of_grain = {});
/// Steps of shapes at rest.
std::vector<ShapeStep> resting_steps(const Walls& walls, std::span<const std::uint8_t> material_of_grain);

}  // namespace drumlin::particles
