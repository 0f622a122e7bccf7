#include "coupling/common/library_words.hpp"

#include <cstdlib>

namespace drumlin {

namespace {
char skip_files[] = "-skip_petscrc";  // kept by PETSc as long as it lives
}

LibraryWords::LibraryWords(char* program) : words{program, skip_files, nullptr} {
  const char* wanted = std::getenv("DRUMLIN_PETSC_OPTIONS");
  setenv("PETSC_OPTIONS", wanted != nullptr ? wanted : "", /*overwrite=*/1);
  unsetenv("PETSC_OPTIONS_YAML");
  setenv("OMP_NUM_THREADS", "1", /*overwrite=*/0);  // read by the BLAS when it is first called
}

}  // namespace drumlin
