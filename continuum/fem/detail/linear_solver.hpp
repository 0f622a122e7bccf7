#pragma once
// The linear systems of one mesh, by MUMPS or by iterations. Private to fem/.
#include <optional>

#include "continuum/fem/detail/direct_solver.hpp"
#include "continuum/fem/detail/iterative_solver.hpp"
#include "continuum/fem/flow_solver.hpp"

namespace drumlin::continuum::fem {

/// Whether a mesh of this many unknowns is to be solved by iterations: what the options say, or by its size.
bool iterates(const FlowSolverOptions& options, double unknowns);

/// Solves by iterations where the options ask for it and the mesh was refined from a coarser one, else by
/// MUMPS. Where the options leave the choice to the size, a system on which the iterations fail is solved by
/// MUMPS.
class LinearSolver {
 public:
  LinearSolver(const FlowSolverOptions& options, const Discretisation& d);

  /// Throws NotConvergedError where factors fail. `matrix` has to outlive the solves.
  void prepare(const SystemMatrix& matrix);
  /// Returns ||A x - b||/||b||, formed with the matrix itself, and adds to `report` what it took. Starts from
  /// `solution` where it iterates.
  double solve(const FieldVector& rhs, FieldVector& solution, LinearReport& report);

 private:
  double solve_with_factors(const FieldVector& rhs, FieldVector& solution);

  const FlowSolverOptions& options_;
  const SystemMatrix* matrix_ = nullptr;
  DirectSolver factors_;
  bool has_factors_ = false;                  // of this matrix
  std::optional<IterativeSolver> iterative_;  // absent: MUMPS alone
};

}  // namespace drumlin::continuum::fem
