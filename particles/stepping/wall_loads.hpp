#pragma once
// Loads on walls as means over an interval of time: impulses of all its steps, impacts among them, summed.
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

/// What a wall shape gave a grain within a step.
struct WallContact {
  std::int32_t i = 0;  ///< grain
  std::int32_t shape = 0;
  double n_x = 0, n_z = 0;  ///< unit normal towards the grain; the tangent is (n_z, -n_x)
  double normal = 0, tangential = 0, couple = 0;  ///< impulses on the grain
};

/// Position of a wall: the middle of its first shape, and the angle turned since the start.
struct WallPlace {
  double x = 0, z = 0, angle = 0;
};

/// Sums over the steps of an interval, of one wall.
struct WallLoad {
  double impulse_x = 0, impulse_z = 0;  ///< of the grains on the wall
  double moment = 0;                    ///< the same about the wall's position, clockwise as drawn
  double time = 0;                      ///< for which it has been there
  WallPlace place;                      ///< times the steps
  WallPlace first, last;                ///< at the beginning and the end
};

/// The interval that runs.
struct WallLoads {
  double time = 0;
  std::vector<WallLoad> walls;  ///< in the order of their names
};

/// Begins an interval with the walls as they are: `shapes` now, `angles` of the walls.
void begin_interval(const Walls&, std::span<const Shape> shapes, std::span<const double> angles, WallLoads&);
/// Adds a step; `shapes` and `angles` at its end.
void add_step(const Walls&, std::span<const Shape> shapes, std::span<const double> angles,
              std::span<const WallContact>, const Bodies&, double time_step, WallLoads&);

}  // namespace drumlin::particles
