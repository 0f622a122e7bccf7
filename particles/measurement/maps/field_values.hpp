#pragma once
// The fields of a map at one node, from the sums there (docs/theory/coarse-graining.md defines each).
#include <cstddef>
#include <limits>
#include <vector>

#include "coupling/exchange/plane_invariants.hpp"
#include "particles/measurement/maps/map_sums.hpp"

namespace drumlin::particles {

/// Least volume fraction at which a node has more than its volume fraction: above the surface a few grains in
/// flight would stand for a field.
constexpr double least_map_nu = 0.05;

/// All fields at one node, with the invariants of stress and velocity gradient among them; NaN where they are
/// not known.
struct MapValues : PlaneInvariants {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double nu = none, number_density = none, v_x = none, v_z = none, omega = none;
  double d_v_x_dx = none, d_v_x_dz = none, d_v_z_dx = none, d_v_z_dz = none;
  double D_xx = none, D_zz = none, D_xz = none, dilation = none;
  double sigma_xx = none, sigma_zz = none, sigma_xz = none, sigma_zx = none;
  double sigma_xx_kinetic = none, sigma_zz_kinetic = none, sigma_xz_kinetic = none;
  double coordination = none, fabric_xx = none, fabric_zz = none, fabric_xz = none;
  double wall_x = none, wall_z = none;
  double residual_x = none, residual_z = none, residual_x_contact = none, residual_z_contact = none;
  double inertia_x = none, inertia_z = none;
  double density = none;
};

struct NamedMapField {
  const char* name;
  double MapValues::*value;
};

/// What sums know beside their nodes, of some batches.
struct MapShare {
  std::size_t snapshots = 0;
  double gravity_x = 0, gravity_z = 0;  ///< flow frame, summed over the snapshots
  bool with_spin = true, with_contacts = true, with_density = false;

  void add(const MapSums& batch);
  /// What is known stays that of all batches.
  void take(const MapShare& batch);
};

/// The fields that the snapshots tell of.
std::vector<NamedMapField> known_fields(const MapShare& total);

/// Sums at one node.
struct NodeSums {
  MapNode node;
  double area = 0;  ///< of the grains, beside their mass

  NodeSums& operator+=(const NodeSums& other);
  NodeSums& operator-=(const NodeSums& other);
};

/// `inside`: share of the kernel within the container. NaN, nu and number_density apart, where nu <
/// least_map_nu.
MapValues values_at(const NodeSums& sums, const MapShare& share, double inside);

}  // namespace drumlin::particles
