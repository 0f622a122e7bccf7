#pragma once
// Sums of coarse graining at the nodes of a map. All of them are linear in the snapshots: those of batches
// can be added and subtracted, node by node, ratios come last (field_maps.hpp).
#include <cstddef>

#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/maps/kernel_grid.hpp"
#include "particles/measurement/maps/node_tiles.hpp"

namespace drumlin::particles {

/// Sums at one node; phi is the kernel around it, m the mass. v: velocity relative to the drum over the
/// stored window; u, that of `motion`: instantaneous, in the laboratory. Components in the flow frame.
struct MapNode : Moments<2> {
  /// At the grains' centres m, m v_x, m v_z, m u_x, m u_z.
  KernelSums<5> carried;
  /// sum of phi at the grains' centres times the force of all contacts on the grain.
  Vector<2> force{};
  /// d/dx m u_x u_x + d/dz m u_x u_z, and the same for z.
  Vector<2> flux_divergence{};
  /// sum of phi at the contacts times the forces of both sides of each; the same of contacts with walls
  /// alone.
  Vector<2> contact_force{}, wall_force{};
  /// At the middle of a displacement d, of a grain relative to the drum from one snapshot to the next after
  /// the time t, m t, m d_x, m d_z.
  KernelSums<3> displaced;

  void add_centre(const KernelWeight& at, const GrainSample<2>& grain);
  /// The fabric takes half of each side, so that a contact with a wall counts half.
  void add_end(double phi, const HalfBranch<2>& branch) {
    add_fabric(phi / 2, branch.normal);
    for (int a = 0; a < 2; ++a) {
      contact_force[a] += phi * branch.force[a];
      if (branch.at_wall) wall_force[a] += phi * branch.force[a];
    }
  }
};

/// What a node of spheres knows besides: components along y, across the plane, per depth as all else.
struct AcrossNode {
  Spread<3> motion;               ///< velocities x, z, y of this instant, by the mass
  double yy = 0, xy = 0, yz = 0;  ///< F_a b_b of contacts, as MapNode has them
};

/// Sums over some snapshots.
struct MapSums {
  NodeTiles<MapNode> nodes;
  NodeTiles<AcrossNode> across;  ///< of discs without tiles
  /// Gravity in the flow frame; pairs of snapshots that displacements were taken from, and the time between
  /// them.
  struct Snapshots : KnownSnapshots {
    double gravity_x = 0, gravity_z = 0;
    double pairs = 0, time = 0;
  } snapshots;
};
MapSums empty_sums(const CoarseGraining& graining);

/// Adds one snapshot: as it is, and in graining.frame; all but displacements.
void add_snapshot(const CoarseGraining& graining, const Snapshot& snapshot, const FlowSnapshot& in_frame,
                  MapSums& sums);

}  // namespace drumlin::particles
