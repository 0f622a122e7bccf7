#pragma once
// Maps with intervals from the sums at their nodes, rows after rows (docs/theory/coarse-graining.md defines
// each field).
#include <cstddef>
#include <functional>
#include <vector>

#include "particles/measurement/maps/map_batches.hpp"
#include "particles/measurement/maps/map_findings.hpp"

namespace drumlin::particles {

/// All fields over some rows of a map, from `first_row` on: the fields of docs/formats/maps.md, NaN outside
/// of the container and, nu and number_density apart, where nu < least_map_nu. Intervals by leaving one batch
/// out each; none with fewer than two batches.
struct MapRows {
  std::size_t first_row = 0, rows = 0;
  std::vector<MapField> fields;
  std::vector<FindingNode> nodes;                  ///< what findings read of them
  std::vector<std::vector<FrictionNode>> without;  ///< one batch each; empty with fewer than two batches
};

/// The grid of the whole map, without the rows above all grains. z counts from `surface_z` (in the frame).
MapGrid map_grid(const MapBatches& batches, double surface_z);

/// Calls action(rows) for the rows of map_grid(), a row of tiles at a time, from the lowest up. In memory are
/// those rows, and the sums of all batches in one tile. `container_radius`: of a circle about the frame's
/// origin; 0: none. There must be a batch.
void each_map_rows(const MapBatches& batches, double container_radius,
                   const std::function<void(const MapRows&)>& action);

}  // namespace drumlin::particles
