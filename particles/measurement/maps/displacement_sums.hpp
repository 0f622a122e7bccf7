#pragma once
// Sums of coarse graining over the displacements of grains from one snapshot to the next: the motion of a
// packing that creeps, where velocities at an instant are noise (docs/theory/coarse-graining.md).
#include <optional>

#include "particles/bodies/cell_path.hpp"
#include "particles/measurement/maps/map_sums.hpp"

namespace drumlin::particles {

/// Follows the grains from snapshot to snapshot, in order of time. Positions are taken in axes that turn with
/// the drum, by its stored angle, so that a packing which turns with it has displacements of zero to
/// rounding, whatever the interval; a displacement stands at the middle of its two ends in these axes, and is
/// turned into the flow frame by the mean angle. Without a drum all is in the laboratory. Across a periodic
/// boundary it is the image that the velocities of both ends come nearest to.
class DisplacementDepositor {
 public:
  explicit DisplacementDepositor(const CoarseGraining& graining) : graining_(graining) {}
  /// The first snapshot is remembered, each later one adds its pair to `sums`; one with other grains (number
  /// or radii) than the one before, or not later than it, is remembered alone. Grains with identities are
  /// matched by these, and those that are in one of both alone are left out.
  void add(const Snapshot& snapshot, MapSums& sums);

 private:
  void add_pair(const Snapshot& before, const Snapshot& now, MapSums& sums) const;

  CoarseGraining graining_;
  std::optional<Snapshot> last_;  ///< without its contacts
};

}  // namespace drumlin::particles
