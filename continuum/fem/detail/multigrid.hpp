#pragma once
// A saddle-point system solved on all nested meshes together. Private to fem/.
#include <petscksp.h>

#include <memory>
#include <vector>

#include "continuum/fem/detail/nesting.hpp"
#include "continuum/fem/detail/patch_smoother.hpp"

namespace drumlin::continuum::fem {

/// A V-cycle over meshes that were refined one from the other. The systems of coarser meshes are P^T A P,
/// with the interpolation P; that of the coarsest mesh is solved by MUMPS.
class Multigrid {
 public:
  /// `nesting`: the first refinement first; it has to outlive this object, as `matrix` has to.
  Multigrid(Mat matrix, const std::vector<bool>& is_pressure, const std::vector<Nesting>& nesting);
  ~Multigrid();
  Multigrid(const Multigrid&) = delete;
  Multigrid& operator=(const Multigrid&) = delete;

  /// The matrix, whose pattern stays, has new values. Throws NotConvergedError where a patch is singular.
  void update();
  /// x = M b, M near the inverse; linear in b up to single precision.
  void apply(Vec b, Vec x);

 private:
  struct Level {
    Mat matrix = nullptr;
    Mat interpolation = nullptr;  // from the next coarser level
    std::unique_ptr<PatchSmoother> smoother;
    Vec b = nullptr, x = nullptr, rest = nullptr;
  };
  void cycle(std::size_t level, Vec b, Vec x);

  std::vector<Level> levels_;  // the finest first
  KSP coarsest_ = nullptr;
};

}  // namespace drumlin::continuum::fem
