#pragma once
// Sums of coarse graining at the nodes of a map. All of them are linear in the snapshots: those of batches
// can be added and subtracted, node by node, ratios come last (field_maps.hpp).
#include <array>
#include <cstddef>
#include <optional>

#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/maps/coarse_graining.hpp"
#include "particles/measurement/maps/node_tiles.hpp"

namespace drumlin::particles {

/// Sums at one node; phi is the kernel around it, x_i a grain's centre, c a contact. v: velocity relative to
/// the drum over the stored window; u: instantaneous, in the laboratory; m: mass, which is the area of a
/// grain without a density of its own. Components in the flow frame.
struct MapNode {
  /// sum of phi(x_i) times 1, contacts, spin, m, m v_x, m v_z, m u_x, m u_z, m u_x u_x, m u_x u_z, m u_z u_z,
  /// and the forces F_x, F_z of all contacts on the grain.
  std::array<double, 13> grain{};
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

  MapNode& operator+=(const MapNode& other);
  MapNode& operator-=(const MapNode& other);
};

/// Sums over some snapshots.
struct MapSums {
  NodeTiles<MapNode> nodes;
  /// sum of phi(x_i) times the area, at each node; nothing where no grain has a density of its own: it is the
  /// mass.
  std::optional<NodeTiles<double>> area;
  std::size_t snapshots = 0;
  double gravity_x = 0, gravity_z = 0;  ///< flow frame, summed over the snapshots
  bool with_spin = true;                ///< false: the scene has no spin
  bool with_contacts = true;            ///< false: the snapshots do not know them

  double area_at(std::size_t node) const { return area ? (*area)[node] : nodes[node].grain[3]; }
};

MapSums empty_sums(const CoarseGraining& graining);

/// Adds one snapshot: as it is, and in graining.frame. Allocates nothing after the first calls.
class MapDepositor {
 public:
  explicit MapDepositor(const CoarseGraining& graining) : graining_(graining) {}
  void add(const Snapshot& snapshot, const FlowSnapshot& in_frame, MapSums& sums);

 private:
  CoarseGraining graining_;
  std::vector<double> force_x_, force_z_;  ///< of all contacts, per grain
};

}  // namespace drumlin::particles
