#pragma once
// Sums over the layers of a slice, or over rings about a point, and over snapshots.
#include <cstddef>
#include <vector>

#include "coupling/results/plane_invariants.hpp"
#include "particles/measurement/frame/disc_area.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"

namespace drumlin::particles {

/// Layers across a slice, in a flow frame: layer l covers z_min + l thickness ... z_min + (l + 1) thickness.
/// Rings about the origin of the frame are layers too: the radius takes the place of z, the tangent, which
/// points clockwise, that of x, so that all sums keep their meaning and their signs.
struct LayerGrid {
  FlowFrame frame;
  double x_min = 0, x_max = 0;  ///< infinite when the slice is a whole period
  double z_min = 0;
  double thickness = 1;
  std::vector<double> area;  ///< of each layer, inside the container
  bool closed = false;       ///< of a cell that is periodic in z: above the top layer follows the lowest
  bool rings = false;
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

/// Rings out to `r_to`, in the axes of the laboratory. container_radius > 0: of a container about the same
/// centre, which cuts the last ring.
LayerGrid ring_grid(double centre_x, double centre_z, double thickness, double r_to, double container_radius);

/// Area common to a disc of `radius` and a circle of radius `circle` whose centres are `distance` apart.
double disc_area_in_circle(double distance, double radius, double circle);

/// Weighted moments of the grains with their centres in a layer; zeta = height above the middle of the layer.
struct Moments {
  double weight = 0, zeta = 0, v_x = 0, v_z = 0;
  double zeta_zeta = 0, zeta_v_x = 0, v_x_v_x = 0, v_z_v_z = 0, v_x_v_z = 0;
};

/// Sums over one layer. Velocities and spins relative to the drum, components in the flow frame.
struct LayerSum {
  double covered = 0, covered_mass = 0;  ///< area of grains inside the layer, its mass
  Moments grains, mass;                  ///< each grain counted once, and by its density
  double x = 0, x_x = 0, x_v_z = 0;      ///< over the same grains, as what follows
  double spin = 0, spin_spin = 0;        ///< 0 in a scene without spin
  double contacts = 0;                   ///< loaded ones
  double rotation = 0;                   ///< J spin^2 / 2, J = m r^2 / 2 the moment of inertia
  PlaneMatrix force_branch;  ///< sum of F_a b_b over the parts of branches inside the layer: F the force on a
                             ///< grain, b from the contact to its centre, so that repulsion counts positive
  /// Over the grains with a Voronoi cell: number, areas, and means over cells (cell_sums.hpp).
  struct Cells {
    double grains = 0, discs = 0, cells = 0, nu = 0, stress_xx = 0, stress_zz = 0, stress_xz = 0;
  } cells;
};

/// Sums of all layers over some snapshots.
struct LayerSums {
  std::vector<LayerSum> layers;
  /// Numbers of snapshots, and of those that know this; of a closed grid area of the cell and speed of the
  /// image above.
  struct Snapshots {
    double count = 0, spin = 0, contacts = 0, densities = 0, cells = 0;
    double cell_area = 0, cell_jump = 0;
  } snapshots;
};
void add_times(double factor, const LayerSums& from, LayerSums& to);

/// Adds one snapshot, seen in the grid's frame. `sums.layers` must have the grid's length. A branch counts in
/// each layer with the share of its length there; in rings forces and velocities have the axes of the place
/// where they are.
void add_snapshot(const LayerGrid& grid, const FlowSnapshot& snapshot, LayerSums& sums);

/// Where a grain's centre lies in its layer, and how it moves, in the axes of the layer.
struct CentreInLayer {
  double x = 0, zeta = 0, v_x = 0, v_z = 0;
};
/// Adds a grain with its centre in the layer: all but covered area and branches.
void add_centre(const CentreInLayer& centre, const FlowSnapshot& snapshot, std::size_t grain, LayerSum& sum);
/// What add_snapshot() does in rings.
void add_to_rings(const LayerGrid& grid, const FlowSnapshot& snapshot, std::vector<LayerSum>& rings);

}  // namespace drumlin::particles
