#pragma once
// Sums of coarse graining over the displacements of grains from one snapshot to the next: the motion of a
// packing that creeps, where velocities at an instant are noise (docs/theory/coarse-graining.md).
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "particles/bodies/cell_path.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/maps/coarse_graining.hpp"
#include "particles/measurement/maps/node_tiles.hpp"

namespace drumlin::particles {

/// Sums at one node: phi is the kernel around the middle of a displacement, m the grain's mass, t the time
/// between the two snapshots, d the displacement relative to the drum, in the flow frame.
struct DisplacementNode {
  std::array<double, 3> sum{};                 ///< of phi times m t, m d_x, m d_z
  std::array<double, 3> slope_x{}, slope_z{};  ///< d/dx and d/dz of them

  DisplacementNode& operator+=(const DisplacementNode& other);
  DisplacementNode& operator-=(const DisplacementNode& other);
};

/// Sums over some pairs of snapshots.
struct DisplacementSums {
  NodeTiles<DisplacementNode> nodes;
  std::size_t pairs = 0;
  double time = 0;  ///< between the snapshots of the pairs, summed
};

DisplacementSums empty_displacements(const CoarseGraining& graining);

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
  void add(const Snapshot& snapshot, DisplacementSums& sums);

 private:
  struct Ends {
    double time = 0, angle = 0;  ///< clockwise; 0 without a drum
    std::vector<double> x, z;    ///< in the drum's axes, from the drum's middle
    std::vector<double> v_x;     ///< laboratory; of a periodic domain alone
    std::vector<double> v_z;     ///< of a cell that is periodic in z alone
    std::optional<CellInstant> cell;
    std::vector<double> radius;
    std::vector<std::int64_t> id;  ///< empty where the number of grains cannot change
  };
  static void find_ends(const Snapshot& snapshot, Ends& ends);
  void add_pair(const Ends& from, const Ends& to, const Snapshot& snapshot, DisplacementSums& sums) const;

  CoarseGraining graining_;
  std::optional<Ends> last_;
};

}  // namespace drumlin::particles
