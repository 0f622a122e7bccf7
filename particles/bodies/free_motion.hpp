#pragma once
// Velocities that grains and walls would have at the end of a step without contacts.
#include <vector>

#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

/// Workspace of a step: effects that act as forces add to it before the contacts are solved.
struct FreeMotion {
  std::vector<double> x, z;    ///< one per grain
  std::vector<double> driven;  ///< one per driven wall, along its direction; after the solve, with contacts
  /// Of each grain, from its position to where its path begins: an impact at a time t within the step
  /// replaces the path by the one that the grain would have come on with the velocity after it. Empty: no
  /// impacts.
  std::vector<Point> shift;
};

}  // namespace drumlin::particles
