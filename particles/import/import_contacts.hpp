#pragma once
// The contacts of one frame as a snapshot holds them.
#include <array>
#include <cstdint>
#include <unordered_map>

#include "particles/bodies/snapshot.hpp"
#include "particles/import/frame_table.hpp"

namespace drumlin::particles {

/// Who the ids of a frame are.
struct FrameBodies {
  std::unordered_map<std::int64_t, std::int32_t> grain;  ///< id -> index in the snapshot
  std::unordered_map<std::int64_t, std::array<double, 2>>
      wall_atoms;  ///< id -> centre, of atoms that are walls
};

/// Adds the contacts that carry a force to a snapshot whose grains are there. A negative j is a wall. The
/// force is f_n, f_t or f_x, f_z, on i; the normal that of the table, else along the centres, at the drum
/// towards its axis. Throws InputError (file, line).
void add_contacts(const FrameTable& table, const FrameBodies& bodies, Snapshot& snapshot);

}  // namespace drumlin::particles
