#pragma once
// Velocities that grains and walls would have at the end of a step without contacts.
#include <vector>

#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

/// Of a grain that impacts have struck: from its position to where its path begins, and the time of the last
/// impact. An impact replaces the path by the one that the grain would have come on with the velocity after
/// it.
struct PathShift : Point {
  double time = 0;
};

/// Workspace of a step: effects that act as forces add to it before the contacts are solved.
struct FreeMotion {
  std::vector<double> x, z;  ///< one per grain
  /// How grains answer impulses in the step; empty: with their inverse masses.
  std::vector<double> inverse_mass;
  std::vector<double> driven;    ///< one per driven wall, along its direction; after the solve, with contacts
  std::vector<PathShift> shift;  ///< one per grain; empty: no impacts
};

}  // namespace drumlin::particles
