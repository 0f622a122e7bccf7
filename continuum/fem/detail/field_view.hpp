#pragma once
// Fields as vectors of PETSc's. Private to fem/.
#include <petscvec.h>

#include "continuum/fem/detail/discretisation.hpp"
#include "continuum/fem/detail/petsc_check.hpp"

namespace drumlin::continuum::fem {

/// PETSc's view of the owned part of a field: no copy.
class FieldView {
 public:
  explicit FieldView(const FieldVector& field) {
    check(VecCreateMPIWithArray(field.get_mpi_communicator(), 1,
                                static_cast<PetscInt>(field.locally_owned_size()),
                                static_cast<PetscInt>(field.size()), field.begin(), &vec_),
          "take a vector");
  }
  ~FieldView() { VecDestroy(&vec_); }
  FieldView(const FieldView&) = delete;
  FieldView& operator=(const FieldView&) = delete;
  Vec get() const { return vec_; }

 private:
  Vec vec_ = nullptr;
};

}  // namespace drumlin::continuum::fem
