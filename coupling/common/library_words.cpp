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
}

}  // namespace drumlin
