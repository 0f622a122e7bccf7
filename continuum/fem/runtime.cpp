#include "continuum/fem/runtime.hpp"

#include <deal.II/base/mpi.h>

#include "coupling/core/machine/first_rank.hpp"
#include "coupling/core/machine/library_words.hpp"

namespace drumlin::continuum {

struct FemRuntime::Libraries {
  explicit Libraries(char** argv) : words(argv[0]), mpi(words.count, words.first, 1) {}
  LibraryWords words;                            // not ours: PETSc would tell of those that it does not know
  dealii::Utilities::MPI::MPI_InitFinalize mpi;  // starts PETSc as well, with one thread
};

FemRuntime::FemRuntime(int&, char**& argv) {
  prepare_libraries();
  libraries_ = std::make_unique<Libraries>(argv);
}

FemRuntime::~FemRuntime() = default;

int FemRuntime::rank() { return static_cast<int>(dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)); }

int FemRuntime::ranks() { return static_cast<int>(dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD)); }

std::vector<double> FemRuntime::of_ranks(double value) {
  return dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, value);
}

void FemRuntime::on_first_rank(const std::function<void()>& action) const {
  on_all_ranks(
      [&] {
        if (rank() == 0) action();
      },
      [](const std::string&) {});
}

void FemRuntime::on_all_ranks(const std::function<void()>& action,
                              const std::function<void(const std::string&)>& say) {
  do_on_all_ranks(
      rank(), action, [](std::int64_t number) { return dealii::Utilities::MPI::min(number, MPI_COMM_WORLD); },
      say);
}

void FemRuntime::require_same(const std::string& text, const std::string& what) {
  require_same_on_ranks(rank(), dealii::Utilities::MPI::all_gather(MPI_COMM_WORLD, text), what);
}

}  // namespace drumlin::continuum
