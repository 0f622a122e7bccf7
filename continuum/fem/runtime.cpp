#include "continuum/fem/runtime.hpp"

#include <deal.II/base/mpi.h>

#include "coupling/common/first_rank.hpp"
#include "coupling/common/library_words.hpp"

namespace drumlin::continuum {

struct FemRuntime::Libraries {
  explicit Libraries(char** argv) : words(argv[0]), mpi(words.count, words.first, 1) {}
  LibraryWords words;                            // not ours: PETSc would tell of those that it does not know
  dealii::Utilities::MPI::MPI_InitFinalize mpi;  // starts PETSc as well, with one thread
};

FemRuntime::FemRuntime(int&, char**& argv) { libraries_ = std::make_unique<Libraries>(argv); }

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
