#pragma once
// Velocities that grains and walls would have at the end of a step without contacts.
#include <vector>

namespace drumlin::particles {

/// Workspace of a step: effects that act as forces add to it before the contacts are solved.
struct FreeMotion {
  std::vector<double> x, z;    ///< one per grain
  std::vector<double> driven;  ///< one per driven wall, along its direction; after the solve, with contacts
};

}  // namespace drumlin::particles
