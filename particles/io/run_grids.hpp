#pragma once
// Grids of a snapshot in SI, as ParaView shows them (docs/formats/vtu.md). (x, z) of the project lies at
// (x, y) of VTK: the plane of its first view.
#include "particles/bodies/snapshot.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/io/vtu_file.hpp"

namespace drumlin::particles {

/// A point per grain with radius, velocity, spin (where there is any) and its number.
VtuGrid grain_grid(const RunFolder& run, const Snapshot& snapshot);

/// A line per loaded contact, from the centre of grain i to that of j, or to the wall, with its impulse and
/// force per metre of depth.
VtuGrid contact_grid(const RunFolder& run, const Snapshot& snapshot);

/// The outlines of all wall shapes where they stand. Throws InputError as shapes_at() does.
VtuGrid wall_grid(const RunFolder& run, const Snapshot& snapshot);

}  // namespace drumlin::particles
