#pragma once
// Nonlocal fluidity: g - length^2 lap g = g_loc. Private to fem/.
#include <span>

#include "continuum/fem/detail/scalar_field.hpp"

namespace drumlin::continuum::fem {

struct FluidityFactor {
  std::shared_ptr<ScalarField> ln_factor;  ///< ln(g_loc/g), continuous, linear on each cell edge
  double linear_residual = 0;              ///< true relative residual of the solve
};

/// From g_loc > 0 per quadrature point of this rank's cells; `length` in d. No flux of g through any side.
/// Linear elements with the mass gathered at the vertices and the gradients taken there, so that g stays
/// positive however small `length` is against the cells; g_loc enters the quotient as the same elements see
/// it, so that the factor is one for length = 0, and its error one of second order in the cells. Collective;
/// throws NotConvergedError where the linear solve misses `linear_tolerance` or g is not positive.
FluidityFactor fluidity_factor(const FlowProblem& problem, const Discretisation& d, double length,
                               std::span<const double> local_fluidity, double linear_tolerance);

/// ln g of the same equation, on linear elements.
std::shared_ptr<ScalarField> spread_fluidity(const FlowProblem& problem, const Discretisation& d,
                                             double length, std::span<const double> local_fluidity,
                                             double linear_tolerance);

}  // namespace drumlin::continuum::fem
