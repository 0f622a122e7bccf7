#pragma once
// Text dumps of LAMMPS: ITEM: TIMESTEP, NUMBER OF ..., BOX BOUNDS, ATOMS or ENTRIES
// (docs.lammps.org/dump.html).
#include <filesystem>
#include <vector>

#include "particles/import/description.hpp"
#include "particles/import/frame_table.hpp"

namespace drumlin::particles {

/// Frames of a dump of atoms, in SI: id, x, z, v_x, v_z, radius, spin_clockwise, type, third (the coordinate
/// across the plane). Scaled coordinates (xs) are put into their box; a triclinic box is refused.
FrameTableSource lammps_grains(std::vector<std::filesystem::path> files, const LammpsSource& source,
                               UnusedColumns& unused);

/// Frames of a dump of contacts, in SI: i, j, f_x, f_z; the force acts on i.
FrameTableSource lammps_contacts(std::vector<std::filesystem::path> files, const LammpsSource& source,
                                 UnusedColumns& unused);

}  // namespace drumlin::particles
