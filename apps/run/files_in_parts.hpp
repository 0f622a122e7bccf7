#pragma once
// Files whose arrays are spread over all ranks, which write them together (MPI-IO): the bytes of the files of
// one process. No rank holds what others have of them.
#include <filesystem>

#include "particles/distributed/ranks.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/io/snapshot_file.hpp"

namespace drumlin::apps {

/// Writes the snapshot whose grains and contacts are those of the parts one after the other; all else is that
/// of the first part. The file is that of write_snapshot(). No part may be without grains. All ranks call it
/// together. Throws IoError on the first rank, FailedOnFirstRank on the others; an older file of that name is
/// then untouched.
void write_snapshot_in_parts(const particles::Ranks& ranks, const std::filesystem::path& file,
                             const particles::Snapshot& part);

/// Writes the checkpoint whose bodies and memory are those of the parts one after the other, all else of the
/// first part, and keeps the one before: the files of keep_checkpoint(). Called, and throws, as above; the
/// older file then stands under its name or as the previous one.
void keep_checkpoint_in_parts(const particles::Ranks& ranks, const std::filesystem::path& run,
                              const particles::Checkpoint& part);

}  // namespace drumlin::apps
