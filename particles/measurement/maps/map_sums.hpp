#pragma once
// Sums of coarse graining at the nodes of a map. All of them are linear in the snapshots: those of batches
// can be added and subtracted, node by node, ratios come last (field_maps.hpp).
#include <array>
#include <cstddef>

#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/maps/coarse_graining.hpp"
#include "particles/measurement/maps/node_tiles.hpp"

namespace drumlin::particles {

/// Sums at one node; phi is the kernel around it, x_i a grain's centre, c a contact. v: velocity relative to
/// the drum over the stored window; u: instantaneous, in the laboratory; m: mass, which is the area of a
/// grain without a density of its own. Components in the flow frame.
struct MapNode {
  /// sum of phi(x_i) times these; velocities and their products times m too.
  struct Grains {
    double number = 0, contacts = 0, spin = 0, mass = 0, v_x = 0, v_z = 0, u_x = 0, u_z = 0;
    double u_x_u_x = 0, u_x_u_z = 0, u_z_u_z = 0;
    double force_x = 0, force_z = 0;  ///< of all contacts on the grain
    double area = 0;
  } grain;
  /// d/dx and d/dz of the sums of m, m v_x, m v_z, m u_x, m u_z.
  std::array<double, 5> slope_x{}, slope_z{};
  /// d/dx m u_x u_x + d/dz m u_x u_z, and the same for z.
  std::array<double, 2> flux_divergence{};
  /// sum over half branches of the integral of phi along it times F_x b_x, F_x b_z, F_z b_x, F_z b_z: F on
  /// the grain, b from the contact to its centre.
  std::array<double, 4> branch{};
  /// sum of phi(c) times F_x, F_z of both sides of each contact; the same of contacts with walls alone; half
  /// of n_x n_x, n_x n_z, n_z n_z for each side (a wall has none).
  std::array<double, 7> contact{};
  /// sum of phi around the middle of a displacement d, of a grain relative to the drum from one snapshot to
  /// the next after the time t, times m t, m d_x, m d_z; d/dx and d/dz of it.
  std::array<double, 3> moved{}, moved_slope_x{}, moved_slope_z{};
};

/// Sums over some snapshots.
struct MapSums {
  NodeTiles<MapNode> nodes;
  /// Numbers of snapshots and of those that know spins, contacts and densities of their own; gravity in the
  /// flow frame; pairs of snapshots that displacements were taken from, and the time between them.
  struct Snapshots {
    double count = 0, spin = 0, contacts = 0, densities = 0;
    double gravity_x = 0, gravity_z = 0;
    double pairs = 0, time = 0;
  } snapshots;
};
MapSums empty_sums(const CoarseGraining& graining);

/// Adds one snapshot: as it is, and in graining.frame; all but displacements.
void add_snapshot(const CoarseGraining& graining, const Snapshot& snapshot, const FlowSnapshot& in_frame,
                  MapSums& sums);

}  // namespace drumlin::particles
