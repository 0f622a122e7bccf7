#pragma once
// Velocity, its gradient and the strain rate from displacements, as fields of a map.
#include <span>

#include "coupling/exchange/field_map.hpp"
#include "particles/measurement/maps/displacement_sums.hpp"

namespace drumlin::particles {

/// Longest mean displacement between two snapshots for which a node has fields, in widths of the kernel:
/// beyond it a displacement is no longer the motion at its middle.
constexpr double longest_displacement = 0.5;

/// Adds the fields displacement_.. of docs/formats/maps.md to `map`, as field_maps() made it of the same
/// graining: its p and stresses stand in displacement_I and displacement_axis_angle_deg. NaN where the map
/// has no v_x, and where the mean displacement over the mean time between snapshots is longer than
/// longest_displacement. Intervals by leaving out one batch each. Adds nothing without a pair of snapshots.
void add_displacement_fields(const CoarseGraining& graining, std::span<const DisplacementSums> batches,
                             FieldMap& map);

}  // namespace drumlin::particles
