#include "continuum/fem/detail/direct_solver.hpp"

#include <petscksp.h>
#include <petscmat.h>

#include <algorithm>
#include <limits>

#include "continuum/fem/detail/dissected_factors.hpp"
#include "continuum/fem/detail/field_view.hpp"
#include "continuum/fem/detail/mumps_scaling.hpp"

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
  KSP solver = nullptr;  // of the whole matrix, on all ranks
  const SystemMatrix* matrix = nullptr;
  DissectedFactors dissected;
  bool is_dissected = false;  // what holds the factors of `matrix`

  ~Petsc() { KSPDestroy(&solver); }
  Mat get() const { return const_cast<SystemMatrix*>(matrix)->petsc_matrix(); }
  void create(MPI_Comm ranks);
  void factorise_whole();
  bool apply_inverse(const FieldVector& rhs, FieldVector& solution);
  double solve(const FieldVector& rhs, FieldVector& solution, double enough);
};

void DirectSolver::Petsc::create(MPI_Comm ranks) {
  check(KSPCreate(ranks, &solver), "create a solver");
  check(KSPSetType(solver, KSPPREONLY), "set up the solver");
  PC factors = nullptr;
  check(KSPGetPC(solver, &factors), "set up the solver");
  check(PCSetType(factors, PCLU), "set up the solver");
  check(PCFactorSetMatSolverType(factors, MATSOLVERMUMPS), "find MUMPS");
}

void DirectSolver::Petsc::factorise_whole() {
  is_dissected = false;
  if (!solver) create(matrix->get_mpi_communicator());
  check(KSPSetOperators(solver, get(), get()), "take the matrix");
  PC factors = nullptr;
  check(KSPGetPC(solver, &factors), "factorise the matrix");
  Mat of_mumps = nullptr;
  check(PCFactorSetUpMatSolverType(factors), "set up the solver");
  check(PCFactorGetMatrix(factors, &of_mumps), "set up the solver");
  check(scale_cheaply(of_mumps), "set up the solver");
  check(KSPSetUp(solver), "factorise the matrix");
  PCFailedReason reason = PC_NOERROR;
  check(PCGetFailedReason(factors, &reason), "factorise the matrix");
  if (reason != PC_NOERROR)
    throw NotConvergedError("MUMPS could not factorise the tangent matrix (singular, or out of memory)");
}

DirectSolver::DirectSolver() : petsc_(std::make_unique<Petsc>()) {}
DirectSolver::~DirectSolver() = default;

void DirectSolver::factorise(const SystemMatrix& matrix) {
  auto& p = *petsc_;
  p.matrix = &matrix;
  p.is_dissected = p.dissected.suits(p.get()) && p.dissected.factorise(p.get());
  if (p.is_dissected)
    KSPDestroy(&p.solver);  // with the factors that it has
  else
    p.factorise_whole();
}

bool DirectSolver::Petsc::apply_inverse(const FieldVector& rhs, FieldVector& solution) {
  const FieldView b(rhs), x(solution);
  if (is_dissected) return dissected.solve(b.get(), x.get());
  check(KSPSolve(solver, b.get(), x.get()), "solve with the factors");
  return true;
}

double DirectSolver::Petsc::solve(const FieldVector& rhs, FieldVector& solution, double enough) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const double size = rhs.l2_norm();
  solution = 0;
  if (size == 0) return 0;
  if (!apply_inverse(rhs, solution)) return none;
  FieldVector remainder(rhs), correction(rhs);
  double residual = remainder_of(*matrix, solution, rhs, remainder) / size;
  for (int step = 0; step < 3 && residual > enough; ++step) {
    if (!apply_inverse(remainder, correction)) return none;
    FieldVector candidate = solution;
    candidate += correction;
    const double improved = remainder_of(*matrix, candidate, rhs, remainder) / size;
    if (!(improved < residual)) break;
    residual = improved;
    solution = candidate;
  }
  return residual;
}

double DirectSolver::solve(const FieldVector& rhs, FieldVector& solution, double enough) const {
  auto& p = *petsc_;
  constexpr double poor = 1e-9;  // beyond which flows and other fields might notice
  const double residual = p.solve(rhs, solution, enough);
  if (residual <= std::max(enough, poor) || !p.is_dissected) return residual;
  // A rank's own unknowns may be worse conditioned than all of them.
  p.dissected.forsake();
  p.factorise_whole();
  return p.solve(rhs, solution, enough);
}

void KeptSystem::add(std::size_t cell, const std::vector<dealii::types::global_dof_index>& unknowns,
                     const dealii::FullMatrix<double>& held,
                     const dealii::AffineConstraints<double>& constraints) {
  if (matrix.local_size() < matrix.m() ||
      std::any_of(unknowns.begin(), unknowns.end(), [&](auto i) { return constraints.is_constrained(i); })) {
    constraints.distribute_local_to_global(held, unknowns, matrix);
    return;
  }
  const std::size_t n = unknowns.size(), first = cell * n * n;
  Mat all = nullptr;  // the block of this rank
  check(MatMPIAIJGetSeqAIJ(matrix.petsc_matrix(), &all, nullptr, nullptr), "read a matrix");
  constexpr PetscInt unknown = -1;
  if (places.size() < first + n * n) places.resize(first + n * n, unknown);
  PetscInt* place = &places[first];
  if (*place == unknown) {
    PetscInt rows = 0;
    const PetscInt *start = nullptr, *columns = nullptr;
    PetscBool done = PETSC_FALSE;
    check(MatGetRowIJ(all, 0, PETSC_FALSE, PETSC_FALSE, &rows, &start, &columns, &done), "read a matrix");
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        place[i * n + j] = static_cast<PetscInt>(std::lower_bound(columns + start[unknowns[i]],
                                                                  columns + start[unknowns[i] + 1],
                                                                  static_cast<PetscInt>(unknowns[j])) -
                                                 columns);
    check(MatRestoreRowIJ(all, 0, PETSC_FALSE, PETSC_FALSE, &rows, &start, &columns, &done), "read a matrix");
  }
  double* entries = nullptr;
  check(MatSeqAIJGetArray(all, &entries), "fill a matrix");
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) entries[*place++] += held(i, j);
  check(MatSeqAIJRestoreArray(all, &entries), "fill a matrix");
}

}  // namespace drumlin::continuum::fem
