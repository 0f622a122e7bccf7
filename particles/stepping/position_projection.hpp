#pragma once
// Removes overlap by moving discs, and walls that a force moves, along the normals of their contacts;
// velocities stay.
#include <cstdint>
#include <span>
#include <vector>

#include "particles/bodies/bodies.hpp"
#include "particles/contact/problems.hpp"
#include "particles/effects/moving_cell.hpp"
#include "particles/effects/wall_step.hpp"
#include "particles/solver/contact_solver.hpp"
#include "particles/stepping/projection_rule.hpp"

namespace drumlin::particles {

/// A contact at the end of a step: the normal points from j to i; j < 0 is a wall.
struct ClosePair {
  std::int32_t i = 0, j = 0;  ///< wall shape s stands as -1 - s
  double gap = 0, n_x = 0, n_z = 0;
};

/// The pairs that are close at the end of a step, among the positions of all: those of a piece stand at its
/// begin.
struct ClosePairs {
  static constexpr std::size_t piece = 1024;
  std::span<const ClosePair> places;      ///< as many as there are pairs, close or not
  std::span<const std::int32_t> earlier;  ///< close pairs of the pieces before each piece, and of all
  bool overlap = false;                   ///< the gap of one of them is negative

  std::size_t count() const { return earlier.empty() ? 0 : earlier.back(); }
  int pieces() const { return earlier.empty() ? 0 : static_cast<int>(earlier.size()) - 1; }
  /// Those of a piece.
  std::span<const ClosePair> of(int p) const {
    return places.subspan(p * piece, earlier[p + 1] - earlier[p]);
  }
};

/// What the projection moves.
struct Movable {
  Bodies& bodies;
  WallStep& walls;                   ///< at the end of the step
  std::span<DrivenState> driven;     ///< in the order of walls.driven
  const MovingCell* cell = nullptr;  ///< gives way where it is under pressure
};

/// Solves 0 <= gap + n.(d_i - d_j), lambda >= 0 in the metric of the masses (the least displacement): a
/// contact problem without friction, on positions. Overlaps ask for a share of themselves only. Walls that a
/// force moves give way along their direction; all others stay.
class PositionProjection {
 public:
  void use(ThreadPool* pool) { work_.pool = pool; }
  void use(World* world) { work_.world = world; }
  /// Takes work space from a memory.
  void use(WorkMemory* memory) { work_.memory = memory; }
  /// What it holds between two calls.
  std::size_t bytes() const {
    const auto& W = problem_.W;
    return bytes_of(W.i) + bytes_of(W.j) + bytes_of(W.n_x) + bytes_of(W.n_z) + bytes_of(W.inverse_mass) +
           bytes_of(problem_.q) + bytes_of(solution_.impulses) + bytes_of(solution_.velocities.bodies) +
           bytes_of(solution_.velocities.contacts);
  }
  /// `pairs` in the order of `plan`.
  void apply(const Movable&, const ClosePairs& pairs, const SweepPlan& plan, const ProjectionRule&);

 private:
  FrictionlessProblem problem_;
  SolverWorkspace<FrictionlessProblem> work_;
  Solution<FrictionlessProblem> solution_;
};

}  // namespace drumlin::particles
