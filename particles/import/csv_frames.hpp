#pragma once
// Snapshots in comma-separated files (docs/formats/import.md).
#include <filesystem>
#include <optional>
#include <vector>

#include "particles/import/frame_table.hpp"

namespace drumlin::particles {

enum class CsvContent { grains, contacts };

/// A frame per file, and per time where there is a column of time. Without one frame n has the time
/// n interval_s; without that either, no time. Comment lines begin with #. Throws InputError (file, line) on
/// the way. `unused` outlives the source.
FrameTableSource csv_frames(std::vector<std::filesystem::path> files, CsvContent content,
                            std::optional<double> interval_s, UnusedColumns& unused);

}  // namespace drumlin::particles
