#pragma once
// Snapshots in tables (docs/formats/import.md).
#include <filesystem>
#include <vector>

#include "particles/import/description.hpp"
#include "particles/import/frame_table.hpp"

namespace drumlin::particles {

enum class CsvContent { grains, contacts };

/// A frame per file, per time where there is a column of time, and per heading where the source has one.
/// Without one frame n has the time n interval_s; without that either, no time. Comment lines begin with #.
/// Throws InputError (file, line) on the way. `notes` outlives the source.
FrameTableSource csv_frames(std::vector<std::filesystem::path> files, CsvContent content,
                            const CsvSource& source, SourceNotes& notes);

}  // namespace drumlin::particles
