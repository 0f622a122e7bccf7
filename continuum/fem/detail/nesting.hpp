#pragma once
// How the unknowns of a mesh follow from those of the mesh that it was refined from. Private to fem/.
#include <petscmat.h>

#include <memory>
#include <type_traits>
#include <vector>

namespace drumlin::continuum::fem {

/// A matrix of PETSc's; the last owner frees it.
using SharedMatrix = std::shared_ptr<std::remove_pointer_t<Mat>>;
inline SharedMatrix shared(Mat matrix) {
  return {matrix, [](Mat owned) { MatDestroy(&owned); }};
}

/// A mesh and the one that it was refined from. Of the coarser mesh only the free unknowns count: those that
/// no constraint determines, numbered rank by rank.
struct Nesting {
  /// Value of each unknown of the finer mesh over the free ones of the coarser; rows of constrained unknowns
  /// are empty. Once the finer mesh is refined itself it has the rows of its free unknowns alone.
  SharedMatrix interpolation;
  std::vector<bool> is_pressure;  ///< per free unknown of the coarser mesh on this rank
};

}  // namespace drumlin::continuum::fem
