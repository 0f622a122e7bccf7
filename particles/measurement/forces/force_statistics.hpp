#pragma once
// Distribution and anisotropy of the contact forces of a slice, by layer and by zone, with 99 % intervals
// (docs/theory/measurement.md).
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/scalar_set.hpp"
#include "particles/measurement/forces/contact_forces.hpp"

namespace drumlin::particles {

/// Where the zones begin and end, and what the contacts are made of. Lengths in d, z from the surface.
struct ForceSettings {
  double surface_z = 0;  ///< of z = 0 in the frame of the grid
  double wall_z = std::numeric_limits<double>::quiet_NaN();
  double H = std::numeric_limits<double>::quiet_NaN();  ///< depth of the flowing layer; NaN: none
  double surface_margin = 1;                            ///< above it contacts are collisions of a few grains
  double interface_gap = 2;                             ///< between H and the static phase
  double wall_margin = 3;                               ///< the wall orders the grains this far
  std::optional<double> friction_grains, friction_walls;  ///< absent: nothing counts as sliding
};

/// One bin of a distribution.
struct DistributionRow {
  std::string quantity;
  double from = 0, to = 0;
  double value = 0, ci99 = 0;
  double contacts = 0;  ///< in the bin
};

struct ForceZone {
  std::string name;             ///< flowing, static, bulk, wall
  double z_from = 0, z_to = 0;  ///< from the surface
  ScalarSet scalars;
  std::vector<DistributionRow> rows;
};

struct ForceStatistics {
  ProfileSet layers;  ///< direction_scalars() of the contacts whose point lies in each, forces as they are
  std::vector<ForceZone> zones;
};

/// From the contacts of each batch of snapshots. In flowing, static and bulk a force is divided by the mean
/// normal force at its depth (linear between the layers' means over the whole run): stress grows with depth,
/// and one mean for a zone of 40 d would mix strong contacts with deep ones. tail_exponent_zone_mean and the
/// rows f_n_zone_mean are what that one mean gives. A zone without contacts is left out.
ForceStatistics force_statistics(const LayerGrid& grid, const std::vector<ContactForces>& batches,
                                 const ForceSettings& settings);

}  // namespace drumlin::particles
