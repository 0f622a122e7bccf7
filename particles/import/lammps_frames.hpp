#pragma once
// Text dumps of LAMMPS: ITEM: UNITS, TIME, TIMESTEP, NUMBER OF ..., BOX BOUNDS, ATOMS or ENTRIES
// (docs.lammps.org/dump.html).
#include <filesystem>
#include <vector>

#include "particles/import/description.hpp"
#include "particles/import/frame_table.hpp"

namespace drumlin::particles {

/// Frames of a dump of atoms, in SI: id, x, z, v_x, v_z, radius, spin_clockwise, third (the coordinate across
/// the plane), and type where some are walls. Of columns that give the same the first is read. Scaled
/// coordinates (xs) are put into their box; in a tilted one they are refused. ITEM: UNITS and ITEM: TIME are
/// read. `notes` outlives the source.
FrameTableSource lammps_grains(std::vector<std::filesystem::path> files, const LammpsSource& source,
                               SourceNotes& notes);

/// Frames of a dump of contacts, in SI: i, j, f_x, f_z; the force acts on i.
FrameTableSource lammps_contacts(std::vector<std::filesystem::path> files, const LammpsSource& source,
                                 SourceNotes& notes);

}  // namespace drumlin::particles
