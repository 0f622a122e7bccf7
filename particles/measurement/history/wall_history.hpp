#pragma once
// Forces between the walls of a run and its grains, snapshot by snapshot, and around a circular container
// sector by sector (docs/formats/history.md).
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "particles/bodies/snapshot.hpp"
#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

/// Part of a circular container: angles from straight below its centre, anticlockwise as drawn, rad. Means
/// over its length of the traction of the wall on the grains.
struct WallSector {
  double from = 0, to = 0;
  double normal = 0;  ///< towards the centre
  double shear = 0;  ///< clockwise as drawn: the sense in which a drum with a positive speed drags the grains
};

/// One wall at one instant, dimensionless, laboratory axes.
struct WallState {
  double force_x = 0, force_z = 0;  ///< of the grains on the wall
  /// Of the grains on the wall, clockwise, about the centre of its container; NaN without one.
  double torque = std::numeric_limits<double>::quiet_NaN();
  std::vector<WallSector> sectors;  ///< of its container; empty without one
};

/// One state per wall. `wall_of_shape`: of each shape that the contacts name; `shapes`: where they are now.
/// A snapshot that does not know its contacts gives NaN.
std::vector<WallState> wall_states(const Snapshot& snapshot, std::size_t walls,
                                   std::span<const int> wall_of_shape, std::span<const Shape> shapes,
                                   std::size_t sectors);

}  // namespace drumlin::particles
