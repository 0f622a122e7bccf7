#pragma once
// How our programs start MPI and PETSc, which deal.II starts with it.
#include <array>

namespace drumlin {

/// What MPI and BLAS are to find in the environment: first of all.
void prepare_libraries();

/// The words that they get: the program's name, and that PETSc reads no file of options, in the current
/// folder or at home, for options can load code. Of its variables only DRUMLIN_PETSC_OPTIONS counts.
struct LibraryWords {
  explicit LibraryWords(char* program);
  LibraryWords(const LibraryWords&) = delete;
  LibraryWords& operator=(const LibraryWords&) = delete;
  int count = 2;
  std::array<char*, 3> words;
  char** first = words.data();
};

}  // namespace drumlin
