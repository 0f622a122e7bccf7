#pragma once
// Layers and rings of spheres with their full tensors: the third components that a view along y lacks.
#include <vector>

#include "coupling/core/results/profile_set.hpp"
#include "particles/measurement/frame/measurement_frame.hpp"
#include "particles/measurement/layers/layer_grid.hpp"

namespace drumlin::particles {

/// Sums over one layer, per depth; components x, z, y. As in the layers of the view, a grain counts once in
/// its motion.
struct SpaceSum : Moments<3, 6> {
  void add_part(double volume, const GrainSample<3>&) { solid += volume; }
  void add_centre(double weight, const GrainSample<3>& grain);
  void add_share(double share, const HalfBranch<3>& branch);
};

/// Sums of all layers over some snapshots.
struct SpaceSums {
  std::vector<SpaceSum> layers;
  KnownSnapshots snapshots;
};
void add_times(double factor, const SpaceSums& from, SpaceSums& to);

/// Layers of one grid, an entry per batch of snapshots. No cell is closed.
struct SpaceLayers {
  LayerGrid grid;
  std::vector<SpaceSums> batches;
};
SpaceLayers empty_space_layers(LayerGrid grid, std::size_t batches);

/// Adds a snapshot of spheres, as it is and in the grid's frame.
void add_snapshot(const LayerGrid& grid, const Snapshot& snapshot, const FlowSnapshot& in_frame,
                  SpaceSums& sums);

/// Columns of docs/formats/spheres.md with intervals, z counted from `surface_z`, 0 of rings.
ProfileSet space_profiles(const SpaceLayers& layers, double surface_z);

}  // namespace drumlin::particles
