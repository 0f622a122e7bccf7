#pragma once
// Contacts of a slice with their forces, collected for their distribution and anisotropy.
#include <cstddef>
#include <memory>

#include "coupling/common/scratch_file.hpp"
#include "particles/bodies/snapshot.hpp"
#include "particles/measurement/layers/layer_sums.hpp"

namespace drumlin::particles {

/// A loaded contact in the flow frame. Single precision: sums over it are double, and a run of 400 snapshots
/// keeps a million of them.
struct ContactForce {
  float z = 0;           ///< of the contact point
  float normal = 0;      ///< repulsion positive; impulse over the last step / time step
  float tangential = 0;  ///< on the body that the normal points to, along the normal turned clockwise
  float direction = 0;   ///< of the normal, rad from x towards z, in [0, pi): a contact has no sense
  float branch = 0;      ///< distance of the two centres, from the centre to the wall
};

/// Contacts of some snapshots; all but the newest wait on the disk.
struct ContactForces {
  ContactForces() : ContactForces(std::make_shared<ScratchFile>()) {}
  explicit ContactForces(const std::shared_ptr<ScratchFile>& file) : between_grains(file), with_walls(file) {}

  ScratchList<ContactForce> between_grains, with_walls;
  std::size_t snapshots = 0;
};

/// Adds the contacts whose point lies in the slice of the grid (in none of its layers: left out).
void add_contact_forces(const LayerGrid& grid, const Snapshot& snapshot, ContactForces& forces);

/// Layer of the grid that holds a height.
inline std::size_t layer_of(const LayerGrid& grid, double z) {
  return static_cast<std::size_t>((z - grid.z_min) / grid.thickness);
}

}  // namespace drumlin::particles
