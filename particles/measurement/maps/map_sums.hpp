#pragma once
// Sums of coarse graining at the nodes of a map. All of them are linear in the snapshots: those of batches
// can be added and subtracted, node by node, ratios come last (field_maps.hpp).
#include <cstddef>

#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/maps/kernel_grid.hpp"
#include "particles/measurement/maps/node_tiles.hpp"

namespace drumlin::particles {

/// Moments at one node, phi the kernel around it.
template <int D>
struct NodeMoments : Moments<D> {
  void add_centre(double phi, const GrainSample<D>& grain) {
    const double area = grain.area();
    Moments<D>::add_centre(phi, grain);
    this->solid += phi * area;
    this->motion.add(phi * (grain.density * area), grain.laboratory_velocity);
  }
  /// The fabric takes half of each side, so that a contact with a wall counts half.
  void add_end(double phi, const HalfBranch<D>& branch) { this->add_fabric(phi / 2, branch.normal); }
};

/// Sums at one node; phi is the kernel around it, m the mass. v: velocity relative to the drum over the
/// stored window; u, that of `motion`: instantaneous, in the laboratory. Components in the flow frame.
struct MapNode : NodeMoments<2> {
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
  void add_end(double phi, const HalfBranch<2>& branch) {
    NodeMoments::add_end(phi, branch);
    for (int a = 0; a < 2; ++a) {
      contact_force[a] += phi * branch.force[a];
      if (branch.at_wall) wall_force[a] += phi * branch.force[a];
    }
  }
};

/// What a node of spheres has besides: the moments in space, per depth as all else.
struct SpaceNode : NodeMoments<3> {
  KernelSums<2> across;  ///< at the centres m, m v_y

  void add_centre(const KernelWeight& at, const GrainSample<3>& grain) {
    NodeMoments::add_centre(at.phi, grain);
    across.add(at, {grain.mass(), grain.mass() * grain.velocity[2]});
  }
};

/// Sums over some snapshots.
struct MapSums {
  NodeTiles<MapNode> nodes;
  NodeTiles<SpaceNode> space;  ///< of discs without tiles
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
