#pragma once
// Sums over the layers of a slice, or over rings about a point, and over snapshots.
#include <vector>

#include "particles/measurement/layers/layer_grid.hpp"

namespace drumlin::particles {

/// Sums over one layer. Velocities and spins relative to the drum, components in the flow frame. In `motion`
/// a grain counts by its density: its area is divided among the layers, its motion is not.
struct LayerSum : Moments<2, 4> {
  double solid_mass = 0;               ///< of the area of grains inside the layer
  Spread<4> each;                      ///< the motion of the same grains, each counted once
  double spin_spin = 0, rotation = 0;  ///< 0 in a scene without spin; J spin^2 / 2
  /// Over the grains with a Voronoi cell: number, areas, and means over cells (cell_sums.hpp).
  struct Cells {
    double grains = 0, discs = 0, cells = 0, nu = 0, stress_xx = 0, stress_zz = 0, stress_xz = 0;
  } cells;

  void add_part(double area, const GrainSample<2>& grain) {
    solid += area;
    solid_mass += grain.density * area;
  }
  void add_centre(double weight, const GrainSample<2>& grain);
};

/// Sums of all layers over some snapshots.
struct LayerSums {
  std::vector<LayerSum> layers;
  struct Snapshots : KnownSnapshots {
    double cells = 0;                     ///< of those with Voronoi cells
    double cell_area = 0, cell_jump = 0;  ///< of a closed grid area of the cell and speed of the image above
  } snapshots;
};
void add_times(double factor, const LayerSums& from, LayerSums& to);

/// Adds one snapshot, seen in the grid's frame. `sums.layers` must have the grid's length.
void add_snapshot(const LayerGrid& grid, const FlowSnapshot& snapshot, LayerSums& sums);

}  // namespace drumlin::particles
