#include "continuum/fem/detail/iterative_solver.hpp"

#include <petscksp.h>

#include "continuum/fem/detail/field_view.hpp"
#include "continuum/fem/detail/multigrid.hpp"
#include "continuum/fem/detail/nested_spaces.hpp"

namespace drumlin::continuum::fem {
namespace {

constexpr int iterations_kept = 30;

PetscErrorCode apply_multigrid(PC shell, Vec b, Vec x) {
  void* multigrid = nullptr;
  PCShellGetContext(shell, &multigrid);
  static_cast<Multigrid*>(multigrid)->apply(b, x);
  return 0;
}

}  // namespace

struct IterativeSolver::Petsc {
  Petsc(const Discretisation& of, int iterations) : d(of), most_iterations(iterations) {}
  Petsc(const Petsc&) = delete;
  Petsc& operator=(const Petsc&) = delete;

  const Discretisation& d;
  const int most_iterations;
  const SystemMatrix* matrix = nullptr;
  std::unique_ptr<Multigrid> multigrid;
  KSP solver = nullptr;

  ~Petsc() { KSPDestroy(&solver); }
  void create();
};

void IterativeSolver::Petsc::create() {
  const Mat petsc = const_cast<SystemMatrix&>(*matrix).petsc_matrix();
  multigrid = std::make_unique<Multigrid>(petsc, pressures(d), d.nesting);
  check(KSPCreate(d.mesh.get_communicator(), &solver), "create a solver");
  // The smoother rounds to single precision: with plain GMRES the true residual stayed twice above its own.
  check(KSPSetType(solver, KSPFGMRES), "set up the solver");
  check(KSPGMRESSetRestart(solver, iterations_kept), "set up the solver");
  check(KSPSetInitialGuessNonzero(solver, PETSC_TRUE), "set up the solver");
  PC shell = nullptr;
  check(KSPGetPC(solver, &shell), "set up the solver");
  check(PCSetType(shell, PCSHELL), "set up the solver");
  check(PCShellSetContext(shell, multigrid.get()), "set up the solver");
  check(PCShellSetApply(shell, apply_multigrid), "set up the solver");
}

IterativeSolver::IterativeSolver(const Discretisation& d, int most_iterations)
    : petsc_(std::make_unique<Petsc>(d, most_iterations)) {}
IterativeSolver::~IterativeSolver() = default;

void IterativeSolver::prepare(const SystemMatrix& matrix) {
  auto& p = *petsc_;
  p.matrix = &matrix;
  if (!p.solver) p.create();
  p.multigrid->update();
  const Mat petsc = const_cast<SystemMatrix&>(matrix).petsc_matrix();
  check(KSPSetOperators(p.solver, petsc, petsc), "take the matrix");
}

IterativeSolver::Outcome IterativeSolver::solve(const FieldVector& rhs, FieldVector& solution,
                                                double tolerance) const {
  const auto& p = *petsc_;
  const double size = rhs.l2_norm();
  if (size == 0) {
    solution = 0;
    return {};
  }
  check(KSPSetTolerances(p.solver, 0, tolerance * size, 1e100, p.most_iterations), "set the tolerance");
  const FieldView b(rhs), x(solution);
  check(KSPSolve(p.solver, b.get(), x.get()), "solve by iterations");
  Outcome outcome;
  PetscInt iterations = 0;
  check(KSPGetIterationNumber(p.solver, &iterations), "count iterations");
  outcome.iterations = static_cast<int>(iterations);
  FieldVector remainder(rhs);
  multiply(*p.matrix, solution, remainder);
  remainder.sadd(-1, 1, rhs);
  outcome.residual = remainder.l2_norm() / size;
  return outcome;
}

}  // namespace drumlin::continuum::fem
