#include "continuum/fem/detail/direct_solver.hpp"

#include <petscksp.h>

#include "continuum/fem/detail/dissected_factors.hpp"
#include "continuum/fem/detail/field_view.hpp"

namespace drumlin::continuum::fem {
namespace {

// b - A x; its norm.
double remainder_of(const SystemMatrix& matrix, const FieldVector& x, const FieldVector& b,
                    FieldVector& remainder) {
  multiply(matrix, x, remainder);
  remainder.sadd(-1, 1, b);
  return remainder.l2_norm();
}

}  // namespace

void multiply(const SystemMatrix& matrix, const FieldVector& x, FieldVector& y) {
  const FieldView from(x), to(y);
  check(MatMult(const_cast<SystemMatrix&>(matrix).petsc_matrix(), from.get(), to.get()), "multiply");
}

struct DirectSolver::Petsc {
  KSP solver = nullptr;
  const SystemMatrix* matrix = nullptr;
  DissectedFactors dissected;
  bool is_dissected = false;  // the factors of `matrix`

  ~Petsc() { KSPDestroy(&solver); }
  void create(MPI_Comm ranks);
  void apply_inverse(const FieldVector& rhs, FieldVector& solution);
};

void DirectSolver::Petsc::create(MPI_Comm ranks) {
  check(KSPCreate(ranks, &solver), "create a solver");
  check(KSPSetType(solver, KSPPREONLY), "set up the solver");
  PC factors = nullptr;
  check(KSPGetPC(solver, &factors), "set up the solver");
  check(PCSetType(factors, PCLU), "set up the solver");
  check(PCFactorSetMatSolverType(factors, MATSOLVERMUMPS), "find MUMPS");
}

DirectSolver::DirectSolver() : petsc_(std::make_unique<Petsc>()) {}
DirectSolver::~DirectSolver() = default;

void DirectSolver::factorise(const SystemMatrix& matrix) {
  auto& p = *petsc_;
  p.matrix = &matrix;
  const Mat petsc = const_cast<SystemMatrix&>(matrix).petsc_matrix();
  p.is_dissected = p.dissected.suits(petsc) && p.dissected.factorise(petsc);
  if (p.is_dissected) return;
  if (!p.solver) p.create(matrix.get_mpi_communicator());
  check(KSPSetOperators(p.solver, petsc, petsc), "take the matrix");
  check(KSPSetUp(p.solver), "factorise the matrix");
  PC factors = nullptr;
  check(KSPGetPC(p.solver, &factors), "factorise the matrix");
  PCFailedReason reason = PC_NOERROR;
  check(PCGetFailedReason(factors, &reason), "factorise the matrix");
  if (reason != PC_NOERROR)
    throw NotConvergedError("MUMPS could not factorise the tangent matrix (singular, or out of memory)");
}

void DirectSolver::Petsc::apply_inverse(const FieldVector& rhs, FieldVector& solution) {
  const FieldView b(rhs), x(solution);
  if (is_dissected) return dissected.solve(b.get(), x.get());
  check(KSPSolve(solver, b.get(), x.get()), "solve with the factors");
}

double DirectSolver::solve(const FieldVector& rhs, FieldVector& solution, double enough) const {
  const double size = rhs.l2_norm();
  solution = 0;
  if (size == 0) return 0;
  petsc_->apply_inverse(rhs, solution);
  FieldVector remainder(rhs), correction(rhs);
  double residual = remainder_of(*petsc_->matrix, solution, rhs, remainder) / size;
  for (int step = 0; step < 3 && residual > enough; ++step) {
    petsc_->apply_inverse(remainder, correction);
    FieldVector candidate = solution;
    candidate += correction;
    const double improved = remainder_of(*petsc_->matrix, candidate, rhs, remainder) / size;
    if (!(improved < residual)) break;
    residual = improved;
    solution = candidate;
  }
  return residual;
}

}  // namespace drumlin::continuum::fem
