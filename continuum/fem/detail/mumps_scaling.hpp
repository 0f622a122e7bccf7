#pragma once
// How MUMPS scales a matrix before it factorises it. Private to fem/.
#include <petscmat.h>

#include "continuum/fem/detail/petsc_check.hpp"

namespace drumlin::continuum::fem {

/// Rows and columns by their largest entries. MUMPS' own choice makes several passes over the matrix, a ninth
/// of a factorisation here, and leaves no smaller residuals. A matrix that lies on several ranks is scaled as
/// MUMPS chooses: it has no other way there.
inline void scale_cheaply(Mat factors) {
  constexpr PetscInt scaling = 8, rows_and_columns = 4;  // ICNTL(8)
  MPI_Comm ranks = MPI_COMM_NULL;
  int size = 0;
  check(PetscObjectGetComm(reinterpret_cast<PetscObject>(factors), &ranks), "set up the solver");
  MPI_Comm_size(ranks, &size);
  if (size == 1) check(MatMumpsSetIcntl(factors, scaling, rows_and_columns), "set up the solver");
}

}  // namespace drumlin::continuum::fem
