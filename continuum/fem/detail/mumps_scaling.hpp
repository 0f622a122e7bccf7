#pragma once
// How MUMPS scales a matrix before it factorises it. Private to fem/.
#include <petscmat.h>

namespace drumlin::continuum::fem {

/// Rows and columns by their largest entries. MUMPS' own choice makes several passes over the matrix, a ninth
/// of a factorisation here, and leaves no smaller residuals. A matrix that lies on several ranks is scaled as
/// MUMPS chooses: it has no other way there.
[[nodiscard]] inline PetscErrorCode scale_cheaply(Mat factors) {
  constexpr PetscInt scaling = 8, rows_and_columns = 4;  // ICNTL(8)
  MPI_Comm ranks = MPI_COMM_NULL;
  int size = 0;
  if (const PetscErrorCode code = PetscObjectGetComm(reinterpret_cast<PetscObject>(factors), &ranks))
    return code;
  MPI_Comm_size(ranks, &size);
  return size == 1 ? MatMumpsSetIcntl(factors, scaling, rows_and_columns) : 0;
}

}  // namespace drumlin::continuum::fem
