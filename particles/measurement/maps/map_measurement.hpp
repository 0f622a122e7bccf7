#pragma once
// Measurement of the maps of a run, with their balance of momentum and their fit of mu(I).
#include <cstddef>
#include <optional>
#include <vector>

#include "particles/measurement/frame/measurement_frame.hpp"
#include "particles/measurement/maps/displacement_sums.hpp"
#include "particles/measurement/maps/field_maps.hpp"
#include "particles/measurement/maps/map_findings.hpp"

namespace drumlin::particles {

/// What grows while the snapshots are read.
struct MapReading {
  CoarseGraining graining;
  std::optional<MapDepositor> depositor;
  std::vector<MapSums> batches;
  std::optional<DisplacementDepositor> follower;
  std::vector<DisplacementSums> displacements;  ///< per batch, that of the later snapshot of a pair
};
/// Nodes over all that the run reaches, at a distance of `spacing`, with a kernel of `width` (d). Throws
/// InputError when the kernel does not suit the spacing.
MapReading begun_maps(const MeasurementFrame& place, double spacing, double width);
/// Adds one snapshot of the batch, as it is and in the frame.
void add_snapshot(const Snapshot& snapshot, const FlowSnapshot& in_frame, std::size_t batch,
                  MapReading& reading);

struct MeasuredMaps {
  FieldMap map;  ///< without header and scales
  MomentumBalance balance;
  BulkFriction friction;
  double displacement_interval = 0;  ///< mean time between the snapshots of a pair; 0: no pair
  LogLine friction_ci99;  ///< half widths for the line of the invariants; NaN with fewer than two batches
};
/// `surface_z`: height of the map's z = 0 in the frame of `place`.
MeasuredMaps measured_maps(const MapReading& reading, const MeasurementFrame& place, double surface_z,
                           const MapFindingOptions& limits);

}  // namespace drumlin::particles
