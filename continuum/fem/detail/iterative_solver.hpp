#pragma once
// GMRES with a V-cycle over nested meshes, with the true residual of every solve. Private to fem/.
#include <memory>

#include "continuum/fem/detail/direct_solver.hpp"

namespace drumlin::continuum::fem {

class IterativeSolver {
 public:
  IterativeSolver(const Discretisation& d, int most_iterations);
  ~IterativeSolver();
  IterativeSolver(const IterativeSolver&) = delete;
  IterativeSolver& operator=(const IterativeSolver&) = delete;

  /// Throws NotConvergedError where a coarser system or a patch is singular. `matrix` has to outlive the
  /// solves.
  void prepare(const SystemMatrix& matrix);
  struct Outcome {
    double residual = 0;  ///< ||A x - b||/||b||, formed with the matrix itself
    int iterations = 0;
  };
  /// From `solution` as it is.
  Outcome solve(const FieldVector& rhs, FieldVector& solution, double tolerance) const;

 private:
  struct Petsc;
  std::unique_ptr<Petsc> petsc_;
};

}  // namespace drumlin::continuum::fem
