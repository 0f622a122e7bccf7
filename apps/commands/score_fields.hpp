#pragma once
// Fields that `drumlin score` is given as a file: as a flow folder, which every comparison reads.
#include <filesystem>

namespace drumlin::apps {

/// Makes `folder`, a FLOWRUN of what a file holds: maps.h5 or profiles.csv of a continuum, or another
/// program's fields in CSV (docs/formats/score.md). Throws InputError on anything else, IoError.
void write_flow_of_fields(const std::filesystem::path& file, const std::filesystem::path& folder);

}  // namespace drumlin::apps
