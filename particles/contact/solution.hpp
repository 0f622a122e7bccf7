#pragma once
// The unknowns of a contact problem: impulses, and the velocities that they cause.
#include <vector>

namespace drumlin::particles {

/// What impulses r do to the bodies and at the contacts.
template <class Delassus>
struct Velocities {
  typename Delassus::State bodies;  ///< change of each body's velocity, M^-1 H^T r; unused by BlockDelassus
  std::vector<double> contacts;     ///< u = W r + q, dim per contact, normal first
};

/// What a solver is given to start from and returns. A caller that keeps it from step to step allocates once.
template <class Problem>
struct Solution {
  std::vector<double> impulses;  ///< dim per contact, normal first. In: the warm start; too short: zeros
  Velocities<typename Problem::Delassus> velocities;  ///< of these impulses; set by every solver
};

}  // namespace drumlin::particles
