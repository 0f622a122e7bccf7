#pragma once
// Removes overlap by moving discs along the normals of their contacts, velocities untouched.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/contact/problems.hpp"
#include "particles/solver/contact_solver.hpp"

namespace drumlin::particles {

/// A contact at the end of a step: the normal points from j to i; j < 0 is a wall.
struct ClosePair {
  std::int32_t i = 0, j = 0;
  double gap = 0, n_x = 0, n_z = 0;
};

/// Solves 0 <= gap + n.(d_i - d_j), lambda >= 0 in the metric of the masses (the least displacement): a
/// contact problem without friction, on positions. Overlaps ask for a share of themselves only.
class PositionProjection {
 public:
  void use(ThreadTeam* team) { work_.team = team; }
  /// Moves `bodies` by at most `sweeps` sweeps; `pairs` in the order of `plan`.
  void apply(Bodies& bodies, std::span<const ClosePair> pairs, const SweepPlan& plan, int sweeps);

 private:
  FrictionlessProblem problem_;
  SolverWorkspace<FrictionlessProblem> work_;
  Solution<FrictionlessProblem> solution_;
};

}  // namespace drumlin::particles
