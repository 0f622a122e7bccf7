#pragma once
// A step in time of second order on one mesh, which damps what is stiff: TR-BDF2 (Bank et al., IEEE Trans.
// Comput.-Aided Des. 4 (1985) 436), what all flows in time share. Private to fem/.
#include "continuum/fem/detail/newton.hpp"

namespace drumlin::continuum::fem {

/// Half of a step, as one of the implicit Euler method: so long, from this sum of what is known, of
/// velocities and of the places of nodes alike.
struct Stage {
  double length = 0;
  double start = 1, middle = 0, rate = 0;  ///< weights of values there, and of their change at the start
};
/// To the middle of a step, by the trapezoidal rule; where no rate is known by the implicit Euler method.
Stage to_middle(double time_step, bool rate_is_known);
/// From start and middle to the end, by the second backward difference.
Stage to_end(double time_step);

/// What a stage starts from; `rate` may be null where it has no weight.
FieldVector from_of(const Stage& stage, const FieldVector& start, const FieldVector& middle,
                    const FieldVector* rate);
/// Of the change along the nodes, at the end of a stage.
std::shared_ptr<const FieldVector> rate_of(const Stage& stage, const FieldVector& from,
                                           const FieldVector& end);

/// What moves the mesh means to a stage.
struct MeshMotion {
  std::shared_ptr<const FieldVector> velocity, passing;  ///< as InertiaSetting's; null: it stays
};

/// One stage, its guess by the rate at the start of the step; null: the level's state. From rest a fluid
/// comes first, then the law at smaller and smaller eps. False where Newton's method fails; the state is its
/// last.
bool advance_once(Newton& newton, const FlowSolverOptions& options, const Stage& stage,
                  const FieldVector& from, const FieldVector* rate, const MeshMotion& motion,
                  SolvedLevel& level);

}  // namespace drumlin::continuum::fem
