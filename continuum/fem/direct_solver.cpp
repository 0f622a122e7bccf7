#include "continuum/fem/detail/direct_solver.hpp"

#include <petscksp.h>

#include <algorithm>
#include <string>
#include <vector>

#include "coupling/exchange/errors.hpp"

namespace drumlin::fem {
namespace {

void check(PetscErrorCode code, const char* what) {
  if (code)
    throw NotConvergedError(std::string("PETSc failed to ") + what + " (code " + std::to_string(code) + ")");
}

}  // namespace

struct DirectSolver::Petsc {
  std::vector<PetscInt> row_start, columns,
      entry_of;  // entry_of: place in (columns, values) of each entry of the pattern
  std::vector<PetscScalar> values;
  Mat matrix = nullptr;
  KSP solver = nullptr;
  const dealii::SparseMatrix<double>* original = nullptr;

  ~Petsc() {
    KSPDestroy(&solver);
    MatDestroy(&matrix);
  }
  void apply_inverse(const dealii::Vector<double>& rhs, dealii::Vector<double>& solution) const;
};

DirectSolver::DirectSolver(const dealii::SparsityPattern& pattern) : petsc_(std::make_unique<Petsc>()) {
  auto& p = *petsc_;
  p.row_start.push_back(0);
  for (dealii::SparsityPattern::size_type row = 0; row < pattern.n_rows(); ++row) {
    std::vector<PetscInt> columns;
    for (auto entry = pattern.begin(row); entry != pattern.end(row); ++entry)
      columns.push_back(static_cast<PetscInt>(entry->column()));
    std::vector<PetscInt> sorted = columns;
    std::sort(sorted.begin(), sorted.end());
    const PetscInt start = p.row_start.back();
    for (const PetscInt column : columns)
      p.entry_of.push_back(
          start +
          static_cast<PetscInt>(std::lower_bound(sorted.begin(), sorted.end(), column) - sorted.begin()));
    p.columns.insert(p.columns.end(), sorted.begin(), sorted.end());
    p.row_start.push_back(static_cast<PetscInt>(p.columns.size()));
  }
  p.values.assign(p.columns.size(), 0);
  const auto n = static_cast<PetscInt>(pattern.n_rows());
  check(MatCreateSeqAIJWithArrays(PETSC_COMM_SELF, n, n, p.row_start.data(), p.columns.data(),
                                  p.values.data(), &p.matrix),
        "take the matrix");
  check(KSPCreate(PETSC_COMM_SELF, &p.solver), "create a solver");
  check(KSPSetType(p.solver, KSPPREONLY), "set up the solver");
  PC factors = nullptr;
  check(KSPGetPC(p.solver, &factors), "set up the solver");
  check(PCSetType(factors, PCLU), "set up the solver");
  check(PCFactorSetMatSolverType(factors, MATSOLVERMUMPS), "find MUMPS");
}

DirectSolver::~DirectSolver() = default;

void DirectSolver::factorise(const dealii::SparseMatrix<double>& matrix) {
  auto& p = *petsc_;
  std::size_t k = 0;
  PetscScalar* values = nullptr;
  check(MatSeqAIJGetArray(p.matrix, &values), "take the matrix");
  for (dealii::SparseMatrix<double>::size_type row = 0; row < matrix.m(); ++row)
    for (auto entry = matrix.begin(row); entry != matrix.end(row); ++entry)
      values[p.entry_of[k++]] = entry->value();
  check(MatSeqAIJRestoreArray(p.matrix, &values), "take the matrix");  // also marks the matrix as changed
  p.original = &matrix;
  check(KSPSetOperators(p.solver, p.matrix, p.matrix), "take the matrix");
  check(KSPSetUp(p.solver), "factorise the matrix");
  PC factors = nullptr;
  check(KSPGetPC(p.solver, &factors), "factorise the matrix");
  PCFailedReason reason = PC_NOERROR;
  check(PCGetFailedReason(factors, &reason), "factorise the matrix");
  if (reason != PC_NOERROR)
    throw NotConvergedError("MUMPS could not factorise the tangent matrix (singular, or out of memory)");
}

void DirectSolver::Petsc::apply_inverse(const dealii::Vector<double>& rhs,
                                        dealii::Vector<double>& solution) const {
  Vec b = nullptr, x = nullptr;
  const auto n = static_cast<PetscInt>(rhs.size());
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, rhs.begin(), &b), "take a vector");
  check(VecCreateSeqWithArray(PETSC_COMM_SELF, 1, n, solution.begin(), &x), "take a vector");
  const PetscErrorCode code = KSPSolve(solver, b, x);
  VecDestroy(&b);
  VecDestroy(&x);
  check(code, "solve with the factors");
}

double DirectSolver::solve(const dealii::Vector<double>& rhs, dealii::Vector<double>& solution) const {
  const double size = rhs.l2_norm();
  solution.reinit(rhs.size());
  if (size == 0) return 0;
  petsc_->apply_inverse(rhs, solution);
  dealii::Vector<double> remainder(rhs.size()), correction(rhs.size());
  double residual = petsc_->original->residual(remainder, solution, rhs) / size;
  for (int step = 0; step < 3 && residual > 1e-12; ++step) {
    petsc_->apply_inverse(remainder, correction);
    dealii::Vector<double> candidate = solution;
    candidate += correction;
    const double improved = petsc_->original->residual(remainder, candidate, rhs) / size;
    if (!(improved < residual)) break;
    residual = improved;
    solution = candidate;
  }
  return residual;
}

}  // namespace drumlin::fem
