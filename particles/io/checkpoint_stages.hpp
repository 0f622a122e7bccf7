#pragma once
// The part of a checkpoint that only scenes have whose stages change something or end early, or that ask for
// loads on walls.
#include <string>
#include <vector>

#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"
#include "particles/io/checkpoint_file.hpp"

namespace drumlin::particles {

/// Adds nothing for other scenes.
void put_stage_changes(const Checkpoint&, H5Content&);
/// Throws InputError when what is there is damaged.
void get_stage_changes(const H5Reader&, Checkpoint&);

/// Finite numbers in whole rows. Throws InputError for others.
std::vector<double> rows_of(const H5Reader&, const std::string& name, std::size_t columns);

}  // namespace drumlin::particles
