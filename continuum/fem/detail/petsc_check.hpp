#pragma once
// What PETSc returns, as an exception. Private to fem/.
#include <petscsys.h>

#include <string>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum::fem {

/// Throws NotConvergedError unless the code is that of success; `what` follows "failed to".
inline void check(PetscErrorCode code, const char* what) {
  if (code)
    throw NotConvergedError(std::string("PETSc failed to ") + what + " (code " + std::to_string(code) + ")");
}

}  // namespace drumlin::continuum::fem
