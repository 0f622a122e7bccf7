#pragma once
// The fluidity that belongs to a velocity and a pressure. Private to fem/.
#include <utility>

#include "continuum/fem/detail/assembly.hpp"
#include "continuum/fem/detail/direct_solver.hpp"

namespace drumlin::continuum::fem {

/// Solves A^2 lap g = mu_loc g - 2|D| for y = ln g where velocity and pressure are given: linear in g, so
/// that it has one solution, and few steps find it from any start. A residual of the momentum after this is
/// that of a flow whose stress depends on the velocity alone; Newton's method for that flow has the tangent
/// of the whole system (docs/decisions.md says what happens where y is left to Newton's method).
/// Made anew with the mesh.
class SettledFluidity {
 public:
  SettledFluidity(const FlowProblem& problem, const Discretisation& d);
  /// Sets y of `state` until a step moves g nowhere by more than `tolerance` of itself. False: it does not
  /// get there, or a linear solve fails. Collective.
  [[nodiscard]] bool settle(const Setting& setting, double tolerance, State& state);
  /// Cuts the part of y in a step to `largest`.
  void limit(double largest, FieldVector& step) const;

 private:
  using Index = dealii::types::global_dof_index;
  struct Source {
    double local, rate;  // mu_loc and 2|D|
  };
  std::vector<Source> sources(const Setting& setting, const State& state) const;
  void assemble(const std::vector<Source>& at_points, bool exact);
  bool step();  // false where the linear solve fails
  bool start_anew(const std::vector<Source>& at_points);
  bool iterate(const std::vector<Source>& at_points, double tolerance);

  const FlowProblem& problem_;
  const Discretisation& d_;
  ScalarField y_;  // on its own, numbered apart from velocity and pressure
  dealii::AffineConstraints<double> lines_;
  std::vector<std::pair<Index, Index>> places_;  // of the cells of this rank: in the flow, in y_
  SystemMatrix matrix_;
  FieldVector residual_, change_;
  DirectSolver factors_;
};

}  // namespace drumlin::continuum::fem
