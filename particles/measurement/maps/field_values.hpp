#pragma once
// The fields of a map at one node, from the sums there (docs/theory/coarse-graining.md defines each).
#include <limits>
#include <string>
#include <vector>

#include "coupling/core/results/plane_invariants.hpp"
#include "particles/measurement/frame/space_invariants.hpp"
#include "particles/measurement/maps/map_sums.hpp"

namespace drumlin::particles {

/// Longest mean displacement between two snapshots for which a node has fields of displacements, in widths of
/// the kernel: beyond it a displacement is no longer the motion at its middle.
constexpr double longest_displacement = 0.5;

/// All fields at one node, with those of all tables and the invariants of stress and velocity gradient among
/// them; NaN where they are not known.
struct MapValues : PlaneInvariants, SharedFields, SpaceInvariants {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double nu = none, number_density = none, v_x = none, v_z = none, omega = none;
  double d_v_x_dx = none, d_v_x_dz = none, d_v_z_dx = none, d_v_z_dz = none;
  double D_xz = none, dilation = none;
  double sigma_xx = none, sigma_zz = none, sigma_xz = none, sigma_zx = none;
  double sigma_xx_kinetic = none, sigma_zz_kinetic = none, sigma_xz_kinetic = none;
  double fabric_xx = none, fabric_zz = none, fabric_xz = none;
  double v_y = none, sigma_yy = none, sigma_xy = none, sigma_yz = none;
  double sigma_yy_kinetic = none, sigma_xy_kinetic = none, sigma_yz_kinetic = none;
  double fabric_yy = none, fabric_xy = none, fabric_yz = none;
  double wall_x = none, wall_z = none;
  double residual_x = none, residual_z = none, residual_x_contact = none, residual_z_contact = none;
  double inertia_x = none, inertia_z = none;
  double density = none;
};

struct MapQuantity {
  std::string name;
  double MapValues::*value;
  double period = 0;       ///< of its values, 0: none; known_fields() sets it
  bool displaced = false;  ///< of the motion by displacements
};
/// The fields that the snapshots tell of.
std::vector<MapQuantity> known_fields(const MapSums::Snapshots& all);

/// `inside`: share of the kernel within the container. NaN, nu and number_density apart, where nu <
/// least_map_nu.
MapValues values_at(const MapNode& sums, const MapSums::Snapshots& snapshots, double inside);

/// What spheres add: the components along y, the invariants in space, and the fabric in place of the plane's.
void set_space(const SpaceNode& sums, const MapSums::Snapshots& snapshots, double inside, MapValues& values);

/// What motion there is by displacements, alone; `pressure` stands in I and in the angle of the axes. NaN
/// without a displacement.
MapValues displaced_values(const MapNode& sums, const PlaneMatrix& pressure);

}  // namespace drumlin::particles
