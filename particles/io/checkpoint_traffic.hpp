#pragma once
// The part of a checkpoint that only scenes have whose number of grains can change, or that grains have
// left.
#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"
#include "particles/io/checkpoint_file.hpp"

namespace drumlin::particles {

/// Adds nothing for other scenes.
void put_traffic(const Checkpoint&, H5Content&);
/// Throws InputError when what is there is damaged.
void get_traffic(const H5Reader&, Checkpoint&);

}  // namespace drumlin::particles
