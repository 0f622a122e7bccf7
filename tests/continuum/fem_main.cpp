// Tests that solve need MPI and PETSc, started once per process.
#include <gtest/gtest.h>

#include "continuum/fem/runtime.hpp"

// OpenMPI and the libraries behind PETSc keep memory until the process ends; the leak check would count it as
// ours. All other checks of the sanitizers stay.
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  const drumlin::continuum::FemRuntime runtime(argc, argv);
  return RUN_ALL_TESTS();
}
