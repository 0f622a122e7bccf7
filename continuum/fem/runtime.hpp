#pragma once
// MPI and PETSc, which want to be started and ended once per program.
#include <memory>

namespace drumlin {

/// Keeps MPI and PETSc alive while it lives: made first thing in main. Libraries run on one thread unless
/// OMP_NUM_THREADS says otherwise: on meshes of this size threads only cost.
class FemRuntime {
 public:
  FemRuntime(int& argc, char**& argv);
  ~FemRuntime();
  FemRuntime(const FemRuntime&) = delete;
  FemRuntime& operator=(const FemRuntime&) = delete;

 private:
  struct Libraries;
  std::unique_ptr<Libraries> libraries_;
};

}  // namespace drumlin
