#pragma once
// frames.h5, written by both sides (docs/formats/frames.md).
#include <filesystem>

#include "coupling/core/results/frames.hpp"

namespace drumlin {

/// Format "drumlin-frames-1", closed by a checksum. Throws InputError on frames that do not fit together,
/// IoError when the file cannot be written; an older file of that name is then untouched.
void write_frames(const std::filesystem::path& file, const Frames& frames);

}  // namespace drumlin
