#include "coupling/core/machine/library_words.hpp"

#include <cstdlib>

namespace drumlin {
namespace {

char skip_files[] = "-skip_petscrc";  // kept by PETSc as long as it lives

}  // namespace

void prepare_libraries() {
  setenv("OMP_NUM_THREADS", "1", /*overwrite=*/0);  // read by the BLAS when it is first called
  // Alone a process is no job whose processes a daemon of MPI, found along PATH, would have to look after.
  setenv("OMPI_MCA_ess_singleton_isolated", "1", /*overwrite=*/0);
}

LibraryWords::LibraryWords(char* program) : words{program, skip_files, nullptr} {
  const char* wanted = std::getenv("DRUMLIN_PETSC_OPTIONS");
  setenv("PETSC_OPTIONS", wanted != nullptr ? wanted : "", /*overwrite=*/1);
  unsetenv("PETSC_OPTIONS_YAML");
}

}  // namespace drumlin
