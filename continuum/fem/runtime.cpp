#include "continuum/fem/runtime.hpp"

#include <deal.II/base/mpi.h>
#include <petscsys.h>

#include <cstdlib>

#include "coupling/common/first_rank.hpp"

namespace drumlin::continuum {

struct FemRuntime::Libraries {
  explicit Libraries(char** argv) : words(argv), mpi(count, words, 1) {}
  int count = 1;  // the name alone: PETSc would tell of words that it does not know
  char** words;
  dealii::Utilities::MPI::MPI_InitFinalize mpi;  // starts PETSc as well, with one thread
};

namespace {

/// Options of PETSc can load code. Only those count that a user asks for by a variable of ours: none of files
/// in the current folder or at home.
void keep_out_options() {
  const char* wanted = std::getenv("DRUMLIN_PETSC_OPTIONS");
  setenv("PETSC_OPTIONS", wanted != nullptr ? wanted : "", /*overwrite=*/1);
  unsetenv("PETSC_OPTIONS_YAML");
  PetscOptionsSetValue(nullptr, "-skip_petscrc", "1");
}

}  // namespace

FemRuntime::FemRuntime(int&, char**& argv) {
  keep_out_options();
  setenv("OMP_NUM_THREADS", "1", /*overwrite=*/0);  // read by the BLAS when it is first called
  libraries_ = std::make_unique<Libraries>(argv);
}

FemRuntime::~FemRuntime() = default;

int FemRuntime::rank() { return static_cast<int>(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)); }

int FemRuntime::ranks() { return static_cast<int>(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD)); }

std::vector<double> FemRuntime::of_ranks(double value) {
  return dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, value);
}

void FemRuntime::on_first_rank(const std::function<void()>& action) const {
  do_on_first_rank(rank() == 0, action,
                   [](int code) { return dealii::Utilities::MPI::broadcast(MPI_COMM_WORLD, code, 0); });
}

}  // namespace drumlin::continuum
