#include "coupling/core/machine/library_words.hpp"

#include <cstdlib>

#include "coupling/core/machine/system_limits.hpp"

namespace drumlin {
namespace {

char skip_files[] = "-skip_petscrc";  // kept by PETSc as long as it lives
constexpr int mpi_files = 32;

}  // namespace

void prepare_libraries() {
  setenv("OMP_NUM_THREADS", "1", /*overwrite=*/0);  // read by the BLAS when it is first called
  // Alone a process is no job whose processes a daemon of MPI, found along PATH, would have to look after.
  setenv("OMPI_MCA_ess_singleton_isolated", "1", /*overwrite=*/0);
  require_open_files(mpi_files);
}

LibraryWords::LibraryWords(char* program) : words{program, skip_files, nullptr} {
  const char* wanted = std::getenv("DRUMLIN_PETSC_OPTIONS");
  setenv("PETSC_OPTIONS", wanted != nullptr ? wanted : "", /*overwrite=*/1);
  unsetenv("PETSC_OPTIONS_YAML");
}

}  // namespace drumlin
