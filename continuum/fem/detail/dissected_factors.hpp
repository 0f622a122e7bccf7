#pragma once
// LU factors on a few ranks: each has those of its own unknowns, and all have those of the unknowns between
// them. Private to fem/.
#include <petscmat.h>

#include <memory>
#include <vector>

namespace drumlin::continuum::fem {

/// The unknowns between ranks are those that are coupled to unknowns of a rank of higher number. Without them
/// the unknowns of two ranks have nothing to do with each other: each rank eliminates its own with factors of
/// MUMPS (one process), and what that leaves between them, a Schur complement of all ranks, is dense and
/// factored by each of them. It is the first cut of a nested dissection, where the mesh has been cut anyhow.
/// All calls are collective.
class DissectedFactors {
 public:
  DissectedFactors();
  ~DissectedFactors();

  /// Whether there are several ranks, each with unknowns of its own, and so few between them that the dense
  /// part costs little beside the rest. Lays out what follows for the pattern of the matrix.
  bool suits(Mat matrix);
  /// After suits() for the same pattern. Returns false if MUMPS fails on any rank, or the dense matrix is
  /// singular; then the pattern suits no more.
  bool factorise(Mat matrix);
  /// x = A^-1 b, without refinement; false if MUMPS fails on any rank.
  bool solve(Vec b, Vec x);
  /// Gives the memory back; the pattern suits no more.
  void forsake();

 private:
  struct Objects;
  std::unique_ptr<Objects> petsc_;
};

}  // namespace drumlin::continuum::fem
