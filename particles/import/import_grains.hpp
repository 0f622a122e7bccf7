#pragma once
// The grains of one frame as a snapshot holds them.
#include <cstdint>
#include <vector>

#include "particles/bodies/snapshot.hpp"
#include "particles/import/description.hpp"
#include "particles/import/frame_table.hpp"
#include "particles/import/import_contacts.hpp"

namespace drumlin::particles {

/// Rows that are grains, in the order of their ids; the rest are atoms of walls.
struct Rows {
  std::vector<std::size_t> grains, wall_atoms;
  std::vector<std::int64_t> id;  ///< of each row of the table
};

/// Throws InputError (file, line) for ids that are none or stand twice, and where there are no grains.
Rows rows_of(const FrameTable& table, const ImportDescription& description);

/// Units from the description; the mean diameter from the first snapshot unless it is given.
Scales scales_for(const ImportDescription& description, const FrameTable& table, const Rows& rows);

/// The state that does not come from the files.
Snapshot frame_of(const ImportDescription& description, const Scales& scales);

/// Places, radii and spins. Throws InputError (file, line) for grains that are not in the drum, not in a
/// plane, without a size, or two in one place.
void add_grains(const FrameTable& table, const Rows& rows, Snapshot& snapshot);
/// Velocities that the table gives.
void add_velocities(const FrameTable& table, const Rows& rows, Snapshot& snapshot);
/// Velocities over the time since the snapshot before, of the same grains.
void add_displacements(const Snapshot& before, Snapshot& snapshot);

FrameBodies bodies_of(const FrameTable& table, const Rows& rows, const Scales& scales);

}  // namespace drumlin::particles
