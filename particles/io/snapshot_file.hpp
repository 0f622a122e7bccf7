#pragma once
// snapshots/NNNNNN.h5: an HDF5 image with a CRC32 trailer, written aside and renamed
// (docs/formats/snapshot.md).
#include <filesystem>
#include <string>
#include <vector>

#include "particles/bodies/snapshot.hpp"

namespace drumlin::particles {

/// The bytes of the file of a snapshot.
std::string snapshot_image(const Snapshot& snapshot);
/// Throws IoError when the file cannot be written; an older file of that name is then untouched.
void write_snapshot(const std::filesystem::path& file, const Snapshot& snapshot);
/// Throws InputError when the file is missing, damaged (CRC), of another version, or inconsistent.
Snapshot read_snapshot(const std::filesystem::path& file);
/// Its time alone, sqrt(d/g).
double snapshot_time(const std::filesystem::path& file);
/// The snapshot files of a run folder, in order of their numbers.
std::vector<std::filesystem::path> snapshot_files(const std::filesystem::path& run);

}  // namespace drumlin::particles
