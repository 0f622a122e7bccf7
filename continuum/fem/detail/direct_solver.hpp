#pragma once
// MUMPS through PETSc, on any number of ranks, with the true residual of every solve. Private to fem/.
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/petsc_sparse_matrix.h>

#include <memory>
#include <vector>

#include "continuum/fem/detail/discretisation.hpp"

namespace drumlin::continuum::fem {

using SystemMatrix = dealii::PETScWrappers::MPI::SparseMatrix;

/// y = A x, on the unknowns that each rank owns.
void multiply(const SystemMatrix& matrix, const FieldVector& x, FieldVector& y);

/// LU factors of one matrix at a time; the ordering is kept as long as the pattern stays. All calls are
/// collective.
class DirectSolver {
 public:
  DirectSolver();
  ~DirectSolver();
  DirectSolver(const DirectSolver&) = delete;
  DirectSolver& operator=(const DirectSolver&) = delete;

  /// Throws NotConvergedError if the factorisation fails. `matrix` has to outlive the solves.
  void factorise(const SystemMatrix& matrix);
  /// Solves, with up to three steps of iterative refinement while the residual is above `enough`; returns
  /// ||A x - b||/||b||, formed with the matrix itself and not with what the factors say of it.
  double solve(const FieldVector& rhs, FieldVector& solution, double enough = 1e-12) const;

 private:
  struct Petsc;
  std::unique_ptr<Petsc> petsc_;
};

/// A matrix with its factors: pattern, ordering and where cells add to it stay from one system on a mesh to
/// the next.
struct KeptSystem {
  SystemMatrix matrix;  ///< given its pattern by the first to fill it
  DirectSolver factors;
  std::vector<PetscInt> places;  ///< of what add() has added, among the entries of the matrix; on one rank

  /// Adds what the cell of this number holds.
  void add(std::size_t cell, const std::vector<dealii::types::global_dof_index>& unknowns,
           const dealii::FullMatrix<double>& held, const dealii::AffineConstraints<double>& constraints);
};

}  // namespace drumlin::continuum::fem
