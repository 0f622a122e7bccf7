#pragma once
// Relaxation of a saddle-point system patch by patch (Vanka 1986). Private to fem/.
#include <petscmat.h>

#include <cstddef>
#include <vector>

namespace drumlin::continuum::fem {

/// For each pressure unknown of this rank, the system of all unknowns of this rank that its equation couples
/// is solved exactly, the other unknowns held, and a part of the correction taken, one patch after the other.
/// What belongs to other ranks is as it was at the start of a sweep. Factors are in single precision: they
/// serve a preconditioner.
class PatchSmoother {
 public:
  PatchSmoother(Mat matrix, const std::vector<bool>& is_pressure);
  ~PatchSmoother();
  PatchSmoother(const PatchSmoother&) = delete;
  PatchSmoother& operator=(const PatchSmoother&) = delete;

  /// A matrix with the same pattern, which has to outlive the sweeps. False: a patch of this rank is
  /// singular.
  [[nodiscard]] bool factorise(Mat matrix);
  /// Improves x in A x = b, from the first patch to the last, or backwards.
  void sweep(Vec b, Vec x, bool forwards, bool from_zero);

 private:
  void find_patches(const std::vector<bool>& is_pressure);
  void relax(std::size_t patch, const double* b, double* x);

  Mat own_ = nullptr, others_ = nullptr;  // columns of this rank, and of the others
  std::vector<PetscInt> unknowns_;        // of all patches
  std::vector<std::size_t> first_{0};     // in unknowns_
  std::vector<std::size_t> first_factor_{0};
  std::vector<float> factors_;    // column by column
  std::vector<PetscInt> single_;  // unknowns of no patch
  std::vector<double> diagonal_;  // theirs
  const PetscInt* start_ = nullptr;
  const PetscInt* column_ = nullptr;
  const double* value_ = nullptr;
  Vec remote_ = nullptr;
  VecScatter scatter_ = nullptr;
  std::vector<double> rest_;  // b less what the others' unknowns take
  std::vector<float> local_;
};

}  // namespace drumlin::continuum::fem
