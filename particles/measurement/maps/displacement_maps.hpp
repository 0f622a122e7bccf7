#pragma once
// Velocity, its gradient and the strain rate from displacements, as fields of a map.
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "coupling/exchange/field_map.hpp"
#include "coupling/exchange/plane_invariants.hpp"
#include "particles/measurement/maps/map_batches.hpp"

namespace drumlin::particles {

/// Longest mean displacement between two snapshots for which a node has fields, in widths of the kernel:
/// beyond it a displacement is no longer the motion at its middle.
constexpr double longest_displacement = 0.5;

/// All fields of displacements at one node.
struct DisplacementMotion {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double v_x = none, v_z = none;
  PlaneMatrix gradient{none, none, none, none};
  double D_xz = none, dilation = none;
  PlaneInvariants invariants = {};
};

/// The fields displacement_.. of docs/formats/maps.md, with intervals by leaving out one batch each; none
/// without a pair of snapshots.
class DisplacementFields {
 public:
  explicit DisplacementFields(const MapBatches& batches);
  /// Appends the fields over so many nodes, all NaN.
  void add_empty_fields(std::size_t nodes, std::vector<MapField>& fields) const;
  /// Sets them, `fields`, at node `at` from the sums of a tile at `place`. The p and the stresses of the map
  /// at this node, `known`, stand in displacement_I and displacement_axis_angle_deg. Leaves NaN where the map
  /// knows no velocity, and where the mean displacement over the mean time between snapshots is longer than
  /// longest_displacement.
  void set_node(const TileOfBatches& tile, std::size_t place, const MapValues& known, std::size_t at,
                std::span<MapField> fields);

 private:
  std::size_t pairs_ = 0;
  double longest_ = 0;                        // mean velocity
  std::vector<DisplacementMotion> left_out_;  // memory used again
  std::vector<double> values_;
};

}  // namespace drumlin::particles
