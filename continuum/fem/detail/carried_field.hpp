#pragma once
// Scalar that the material carries along and renews: v.grad b = rate (target - b). Private to fem/.
#include <span>

#include "continuum/fem/detail/scalar_field.hpp"

namespace drumlin::continuum::fem {

/// Per quadrature point of this rank's cells.
struct Relaxation {
  std::span<const double> rate;    ///< > 0, 1/sqrt(d/g)
  std::span<const double> target;  ///< what b tends to
};

struct CarriedField {
  std::shared_ptr<ScalarField> field;  ///< bilinear on each cell, with jumps between them
  double linear_residual = 0;          ///< true relative residual of the solve
  double overshoot = 0;  ///< by how much the solve left the range of the targets, over that range, before it
                         ///< was brought back
};

/// The steady b in the velocity of `solution`: discontinuous elements, each of which takes what flows in from
/// its neighbours upwind. The form is that of v.grad b and not of div(b v), so that a b that is the same
/// everywhere stays so whatever div v the elements leave. Streamlines may close on themselves: `rate` > 0
/// makes b there a mean over the way. Where material enters through a side, by what the elements let through,
/// it comes with the mean target of its cell. In each cell b is drawn towards its mean until it lies within
/// the range of the targets, as exact solutions do. Second order where b is smooth. Collective; throws
/// NotConvergedError where the linear solve misses `linear_tolerance`.
CarriedField carried_by_flow(const FlowProblem& problem, const Discretisation& d, const FieldVector& solution,
                             const Relaxation& relaxation, double linear_tolerance);

}  // namespace drumlin::continuum::fem
