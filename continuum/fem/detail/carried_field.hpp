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

/// Per quadrature point of this rank's cells.
struct AxesRelaxation {
  std::span<const double> rate;                  ///< > 0, 1/sqrt(d/g)
  std::span<const double> target_xx, target_xz;  ///< of a traceless tensor, magnitude at most one
};

/// Draws A, two components as below, in each cell towards its mean until |A| <= 1: at every node of the cell,
/// and so everywhere in it.
void bring_into_unit_disc(const Discretisation& d, ScalarField& field);

/// A traceless tensor A (components xx and xz of the field) that the material turns with itself and renews,
/// v.grad A + 2 i W A = rate (target - A) for A as the complex number xx + i xz: as carried_by_flow, the two
/// components in one system, velocity and spin W those of the laboratory. In each cell A is drawn towards its
/// mean until |A| <= 1, a magnitude that no turn of the axes changes.
std::shared_ptr<ScalarField> axes_carried_by_flow(const FlowProblem& problem, const Discretisation& d,
                                                  const FieldVector& solution,
                                                  const AxesRelaxation& relaxation, double linear_tolerance);

}  // namespace drumlin::continuum::fem
