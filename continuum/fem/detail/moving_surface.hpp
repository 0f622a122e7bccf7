#pragma once
// Misfit of a moving surface (its normal stress, as heights) and its derivative by the shape. Private to
// fem/.
#include <deal.II/lac/full_matrix.h>

#include "continuum/fem/detail/newton.hpp"

namespace drumlin::continuum::fem {

/// sigma_nn/(nu cos theta) along the surface, d.
struct SurfaceMisfit {
  /// The polynomials of SurfaceShape that come closest to it. Near the ends it counts less, with the square
  /// of the distance from them over 2 d: velocity and stress of the last cell are no field.
  std::vector<double> coefficient;
  double resolved = 0;  ///< rms of those polynomials that the shape is free to change
  double rms = 0;       ///< of all, more than 2 d from the ends
  double largest = 0;   ///< likewise
};

/// Of the coefficients of a shape, the first that is a free unknown: those before it follow (restrain).
std::size_t first_free(const FlowProblem&);
/// Over which length the slope of the middle is nought; 0: the slope of the axes is given, and no such thing
/// holds.
double slope_half_length(const FlowProblem&);

/// Collective.
SurfaceMisfit surface_misfit(const FlowProblem&, const Discretisation&, const State&);

/// Derivatives of a flow and its misfit by the free coefficients of the shape when the flow follows.
struct SurfaceResponse {
  dealii::FullMatrix<double> matrix;      ///< of the free coefficients of the misfit
  std::vector<FieldVector> of_flow = {};  ///< of velocity and pressure, for each coefficient
  std::vector<double> of_theta = {};
};

/// By differences, one linear solve for each coefficient with the factors of the tangent. Leaves the level
/// after one step of Newton's method with the surface as it is. Throws NotConvergedError, the surface then
/// being off by a difference.
SurfaceResponse surface_response(Newton&, SolvedLevel&);

/// x of A x = b.
std::vector<double> solution_of(dealii::FullMatrix<double> A, const std::vector<double>& b);

}  // namespace drumlin::continuum::fem
