#include "continuum/fem/detail/multigrid.hpp"

#include "continuum/fem/detail/petsc_check.hpp"

namespace drumlin::continuum::fem {

Multigrid::Multigrid(Mat matrix, const std::vector<bool>& is_pressure, const std::vector<Nesting>& nesting)
    : levels_(nesting.size() + 1) {
  levels_.front().matrix = matrix;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    Level& level = levels_[l];
    if (l > 0) {
      Level& finer = levels_[l - 1];
      finer.interpolation = nesting[nesting.size() - l].interpolation.get();
      check(MatPtAP(finer.matrix, finer.interpolation, MAT_INITIAL_MATRIX, 2.0, &level.matrix),
            "form a coarser system");
      check(MatCreateVecs(level.matrix, &level.x, &level.b), "make a vector");
    }
    check(MatCreateVecs(level.matrix, nullptr, &level.rest), "make a vector");
    if (l + 1 < levels_.size())
      level.smoother = std::make_unique<PatchSmoother>(
          level.matrix, l == 0 ? is_pressure : nesting[nesting.size() - l].is_pressure);
  }
  check(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(matrix)), &coarsest_), "create a solver");
  check(KSPSetType(coarsest_, KSPPREONLY), "set up the solver");
  PC factors = nullptr;
  check(KSPGetPC(coarsest_, &factors), "set up the solver");
  check(PCSetType(factors, PCLU), "set up the solver");
  check(PCFactorSetMatSolverType(factors, MATSOLVERMUMPS), "find MUMPS");
}

Multigrid::~Multigrid() {
  KSPDestroy(&coarsest_);
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    if (l > 0) MatDestroy(&levels_[l].matrix);
    VecDestroy(&levels_[l].b);
    VecDestroy(&levels_[l].x);
    VecDestroy(&levels_[l].rest);
  }
}

void Multigrid::update() {
  int regular = 1;
  for (std::size_t l = 0; l < levels_.size(); ++l) {
    if (l > 0)
      check(MatPtAP(levels_[l - 1].matrix, levels_[l - 1].interpolation, MAT_REUSE_MATRIX, 2.0,
                    &levels_[l].matrix),
            "form a coarser system");
    if (levels_[l].smoother && !levels_[l].smoother->factorise(levels_[l].matrix)) regular = 0;
  }
  MPI_Allreduce(MPI_IN_PLACE, &regular, 1, MPI_INT, MPI_MIN,
                PetscObjectComm(reinterpret_cast<PetscObject>(coarsest_)));
  if (!regular) throw NotConvergedError("a patch of the iterative solver is singular");
  check(KSPSetOperators(coarsest_, levels_.back().matrix, levels_.back().matrix), "take the matrix");
  check(KSPSetUp(coarsest_), "factorise the coarsest system");
}

void Multigrid::apply(Vec b, Vec x) { cycle(0, b, x); }

void Multigrid::cycle(std::size_t l, Vec b, Vec x) {
  if (l + 1 == levels_.size()) {
    check(KSPSolve(coarsest_, b, x), "solve the coarsest system");
    return;
  }
  Level& level = levels_[l];
  Level& coarser = levels_[l + 1];
  check(VecSet(x, 0), "relax");
  level.smoother->sweep(b, x, /*forwards=*/true, /*from_zero=*/true);
  check(MatMult(level.matrix, x, level.rest), "relax");
  check(VecAYPX(level.rest, -1, b), "relax");
  check(MatMultTranspose(level.interpolation, level.rest, coarser.b), "restrict");
  cycle(l + 1, coarser.b, coarser.x);
  check(MatMultAdd(level.interpolation, coarser.x, x, x), "interpolate");
  level.smoother->sweep(b, x, /*forwards=*/false, /*from_zero=*/false);
}

}  // namespace drumlin::continuum::fem
