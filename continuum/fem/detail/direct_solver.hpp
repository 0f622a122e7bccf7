#pragma once
// MUMPS through PETSc, with the true residual of every solve. Private to fem/.
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <memory>

namespace drumlin::fem {

/// LU factors of one matrix at a time; the ordering is kept as long as the pattern stays.
class DirectSolver {
 public:
  explicit DirectSolver(const dealii::SparsityPattern& pattern);
  ~DirectSolver();
  DirectSolver(const DirectSolver&) = delete;
  DirectSolver& operator=(const DirectSolver&) = delete;

  /// Throws NotConvergedError if the factorisation fails.
  void factorise(const dealii::SparseMatrix<double>& matrix);
  /// Solves with up to three steps of iterative refinement; returns ||A x - b||/||b||, formed with the matrix
  /// itself and not with what the factors say of it.
  double solve(const dealii::Vector<double>& rhs, dealii::Vector<double>& solution) const;

 private:
  struct Petsc;
  std::unique_ptr<Petsc> petsc_;
};

}  // namespace drumlin::fem
