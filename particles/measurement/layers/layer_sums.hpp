#pragma once
// Sums over the layers of a slice and over snapshots; sums of batches can be added and subtracted.
#include <cstddef>
#include <vector>

#include "particles/measurement/frame/disc_area.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"

namespace drumlin::particles {

/// Layers across a slice, in a flow frame. Layer l covers z_min + l thickness ... z_min + (l + 1) thickness.
struct LayerGrid {
  FlowFrame frame;
  double x_min = 0, x_max = 0;  ///< infinite when the slice is a whole period
  double z_min = 0;
  double thickness = 1;
  std::vector<double> area;  ///< of each layer, inside the container
  bool closed = false;       ///< of a cell that is periodic in z: above the top layer follows the lowest
  std::size_t layers() const { return area.size(); }
  double z_max() const { return z_min + static_cast<double>(layers()) * thickness; }
  /// The layer that holds a height; layers() and more outside. Every grain of a closed cell is in one.
  std::size_t layer_at(double z) const;
  /// The same layers as the cell of a snapshot has them: equal shares of its height.
  LayerGrid in_cell(const FlowCell& cell) const;
  double z_of(std::size_t layer) const { return z_min + (static_cast<double>(layer) + 0.5) * thickness; }
  Rectangle rectangle(std::size_t layer) const;
};

/// Grid over z_from ... z_to with boundaries at whole multiples of the thickness. container_radius 0: no
/// container; otherwise its axis is the frame's origin and layers count with their area inside. `period` > 0:
/// the slice is the period.
LayerGrid layer_grid(const FlowFrame& frame, double position, double slice_width, double thickness,
                     double z_from, double z_to, double container_radius, double period);

/// Equal layers, as thick as asked for to rounding to a whole number of them, over a cell that is periodic in
/// x and z.
LayerGrid closed_grid(const FlowFrame& frame, double thickness, double z_from, double z_to, double period);

/// Sums over one layer. Velocities and spins relative to the drum, components in the flow frame; zeta =
/// height of a grain's centre above the middle of its layer.
struct LayerSum {
  double covered = 0;  ///< area of grains inside the layer
  double grains = 0;   ///< number of centres in it; the sums below run over them
  double x = 0, zeta = 0, v_x = 0, v_z = 0, spin = 0;
  double x_x = 0, zeta_zeta = 0, zeta_v_x = 0, x_v_z = 0;
  double v_x_v_x = 0, v_z_v_z = 0, v_x_v_z = 0, spin_spin = 0;
  /// sum of F_a b_b over the parts of branches inside the layer: F the force on a grain, b from the contact
  /// to its centre, so that repulsion counts positive.
  double force_x_branch_x = 0, force_x_branch_z = 0, force_z_branch_x = 0, force_z_branch_z = 0;
  double contacts = 0;  ///< loaded contacts of the grains counted
  double rotation = 0;  ///< sum of J spin^2 / 2 over them, J = m r^2 / 2 the moment of inertia
  /// Of grains with densities of their own, else 0: mass of the covered area, sum of the densities, and the
  /// sums of the same names with each grain counted by its density.
  double covered_mass = 0, density = 0;
  double dense_zeta = 0, dense_v_x = 0, dense_v_z = 0, dense_zeta_zeta = 0, dense_zeta_v_x = 0;
  double dense_v_x_v_x = 0, dense_v_z_v_z = 0, dense_v_x_v_z = 0;

  LayerSum& operator+=(const LayerSum& other);
  LayerSum& operator-=(const LayerSum& other);
};

/// Where a grain's centre lies in its layer, and how it moves, in the axes of the layer.
struct CentreInLayer {
  double x = 0, zeta = 0, v_x = 0, v_z = 0;
};
/// Adds a grain with its centre in the layer: all but covered area and branches.
void add_centre(const CentreInLayer& centre, const FlowSnapshot& snapshot, std::size_t grain, LayerSum& sum);

/// Sums of all layers over some snapshots.
struct LayerSums {
  std::vector<LayerSum> layers;
  std::size_t snapshots = 0;
  bool with_spin = true;        ///< false: the scene has no spin
  bool with_contacts = true;    ///< false: the snapshots do not know them
  bool with_densities = false;  ///< grains have densities of their own
  /// Of a closed grid, summed over the snapshots: area of the cell, speed of the image above.
  double cell_area = 0, cell_jump = 0;

  LayerSums& operator+=(const LayerSums& other);
  LayerSums& operator-=(const LayerSums& other);
};

/// Adds one snapshot, seen in the grid's frame. `sums.layers` must have the grid's length.
void add_snapshot(const LayerGrid& grid, const FlowSnapshot& snapshot, LayerSums& sums);

}  // namespace drumlin::particles
