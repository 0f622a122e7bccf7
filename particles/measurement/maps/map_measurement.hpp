#pragma once
// Measurement of the maps of a run, with their balance of momentum and their fit of mu(I).
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>

#include "particles/measurement/frame/measurement_frame.hpp"
#include "particles/measurement/maps/displacement_sums.hpp"
#include "particles/measurement/maps/field_maps.hpp"
#include "particles/measurement/maps/map_findings.hpp"

namespace drumlin::particles {

/// What grows while the snapshots are read: the sums of one batch, the others being put away.
struct MapReading {
  CoarseGraining graining;
  std::shared_ptr<ScratchFile> file;
  std::optional<DisplacementDepositor> follower;
  std::size_t batch = 0;  ///< that grows
  MapSums sums;           ///< a pair of snapshots belongs to the batch of the later one
  std::optional<MapBatches> batches;

  /// Of all of this, whatever the number of snapshots and batches.
  std::size_t bytes_in_memory() const;
};
/// Nodes over all that the run reaches, at a distance of `spacing`, with a kernel of `width` (d). What does
/// not fit into memory goes to `file`. Throws InputError when the kernel does not suit the spacing.
MapReading begun_maps(const MeasurementFrame& place, double spacing, double width,
                      std::shared_ptr<ScratchFile> file);
/// Adds one snapshot of the batch, as it is and in the frame; batches in ascending order.
void add_snapshot(const Snapshot& snapshot, const FlowSnapshot& in_frame, std::size_t batch,
                  MapReading& reading);

/// Where the rows of a map go, from the lowest up. `grid` is that of the whole map.
using MapRowSink = std::function<void(const MapGrid& grid, const MapRows& rows)>;

struct MeasuredMaps {
  MomentumBalance balance;
  BulkFriction friction;
  double displacement_interval = 0;  ///< mean time between the snapshots of a pair; 0: no pair
  LogLine friction_ci99;  ///< half widths for the line of the invariants; NaN with fewer than two batches
};
/// Ends the reading and hands the map out. `surface_z`: height of the map's z = 0 in the frame of `place`.
MeasuredMaps measured_maps(MapReading reading, const MeasurementFrame& place, double surface_z,
                           const MapFindingOptions& limits, const MapRowSink& sink);

}  // namespace drumlin::particles
