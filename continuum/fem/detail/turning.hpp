#pragma once
// Side and degree to which k turns the axes of the stress, as a field on a mesh: what the law with k takes
// from the flow beyond D and p. It needs second derivatives of the velocity and is held while Newton's method
// runs. Private to fem/.
#include <deal.II/fe/fe_q.h>

#include <functional>
#include <memory>
#include <vector>

#include "continuum/fem/detail/scalar_field.hpp"

namespace drumlin::continuum::fem {

/// s sgn(W - Omega_D) as a continuous field, linear on each cell edge.
struct Turning {
  explicit Turning(const Discretisation& d);
  Turning(const Turning&) = delete;
  Turning& operator=(const Turning&) = delete;

  dealii::FE_Q<2> element{1};
  dealii::DoFHandler<2> places;
  FieldVector turn;                   ///< with the copies around this rank's part
  std::function<double(Vec2)> given;  ///< in place of `turn`; empty: absent
  std::vector<double> at_quadrature;  ///< per quadrature point of this rank's cells
};

/// The turn at points of one cell, given by their places in the reference cell.
std::vector<double> turn_at(const Turning& turning, const Discretisation& d,
                            const dealii::DoFHandler<2>::active_cell_iterator& cell,
                            const std::vector<dealii::Point<2>>& unit_points);

/// From the velocity of a solution. D is recovered as a continuous field, the mean over the cells around each
/// node, and its angle differentiated along the velocity; then the turn is formed at the vertices in the same
/// way. `before` (null: none) is mixed in with 1 - share. Collective.
std::shared_ptr<const Turning> turning_of(const FlowProblem& problem, const Discretisation& d,
                                          double regularisation_rate, const FieldVector& solution,
                                          const Turning* before = nullptr, double share = 1);

}  // namespace drumlin::continuum::fem
