#pragma once
// Balance of momentum and fit of mu(I) over the whole of a map.
#include <cstddef>
#include <limits>
#include <vector>

#include "coupling/core/results/field_map.hpp"

namespace drumlin::particles {

/// Where the packing ends, in the coordinates of the map.
struct MapBounds {
  double container_radius = 0;  ///< 0: none
  double axis_z = 0;            ///< of the container
  /// Without a container: floor and sides; infinite where there is none.
  double x_min = -std::numeric_limits<double>::infinity();
  double x_max = std::numeric_limits<double>::infinity();
  double z_min = -std::numeric_limits<double>::infinity();
};

struct MapFindingOptions {
  double margin = 3;                  ///< d that the bulk keeps from the wall and from the surface above it
  double surface_nu = 0.7;            ///< of the surface, column by column
  double flowing_I = 1e-2;            ///< I from which a node counts as flowing
  double block = 10;                  ///< d, side of the squares over which the residual is averaged
  double I_min = 1e-4, I_max = 1e-1;  ///< of the fits of mu(I)
};

/// What the fit of mu(I) reads of a node, and what all findings do; NaN where it is not known.
struct FrictionNode {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double nu = none, p = none, I = none, mu = none;
};
struct FindingNode : FrictionNode {
  double d_v_x_dz = none, sigma_xz = none, sigma_zz = none;
  double residual_x = none, residual_z = none;
  double residual_x_contact = none, residual_z_contact = none;  ///< with the kinetic stress left out
  double inertia_x = none, inertia_z = none;
  double mu_ci99 = none, residual_x_ci99 = none, residual_z_ci99 = none;
};

/// Nodes of a map, row after row from the lowest up, of which findings are made.
struct FindingMap {
  MapGrid grid;
  std::vector<FindingNode> nodes;
};

/// Nodes of the map in the bulk.
std::vector<std::size_t> bulk_nodes(const FindingMap& map, const MapBounds& bounds,
                                    const MapFindingOptions& options);

/// What is missing in the balance of momentum over some nodes, in units of nu g.
struct BalanceResidual {
  std::size_t nodes = 0;
  double rms_x = 0, rms_z = 0;
  double mean_x = 0, mean_z = 0;
  double noise_x = 0, noise_z = 0;            ///< rms of the residual's standard error; NaN without batches
  double rms_x_blocks = 0, rms_z_blocks = 0;  ///< of the means over squares; NaN when no square is full
  double rms_x_without_kinetic = 0, rms_z_without_kinetic = 0;  ///< with the kinetic stress left out
  double rms_inertia = 0;  ///< rms of nu v.grad v of the mean velocity, both components
};

struct MomentumBalance {
  BalanceResidual bulk, flowing, slow;  ///< slow: the bulk that does not flow
};
/// `batches`: behind the map's intervals. Squares stand side by side from x = z = 0 on and count when three
/// quarters of their nodes belong to the zone.
MomentumBalance momentum_balance(const FindingMap& map, const MapBounds& bounds,
                                 const MapFindingOptions& options, std::size_t batches);

/// Straight line through y over ln I, every node with the same weight.
struct LogLine {
  double a = std::numeric_limits<double>::quiet_NaN(), b = a, rms = a;  ///< y = a + b ln I
  std::size_t nodes = 0;
};

/// mu(I) over the bulk: by invariants (mu = |tau|/p over I), and as layers have it (sigma_xz/sigma_zz over
/// dv_x/dz / sqrt(sigma_zz), where that is positive).
struct BulkFriction {
  LogLine invariant, ratio;
  std::size_t bulk = 0;  ///< nodes of the bulk
  double noise =
      std::numeric_limits<double>::quiet_NaN();  ///< rms standard error of mu over the invariant's nodes
};
BulkFriction bulk_friction(const FindingMap& map, const MapBounds& bounds, const MapFindingOptions& options,
                           std::size_t batches);

}  // namespace drumlin::particles
