#include "continuum/fem/runtime.hpp"

#include <deal.II/base/mpi.h>

#include <cstdlib>

namespace drumlin {

struct FemRuntime::Libraries {
  Libraries(int& argc, char**& argv) : mpi(argc, argv, 1) {}
  dealii::Utilities::MPI::MPI_InitFinalize mpi;  // starts PETSc as well, with one thread
};

FemRuntime::FemRuntime(int& argc, char**& argv) {
  setenv("OMP_NUM_THREADS", "1", /*overwrite=*/0);  // read by the BLAS when it is first called
  libraries_ = std::make_unique<Libraries>(argc, argv);
}

FemRuntime::~FemRuntime() = default;

}  // namespace drumlin
