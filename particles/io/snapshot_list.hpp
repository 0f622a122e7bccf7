#pragma once
// Lists of snapshots of a run: "all", "last", or numbers and ranges as in "1,5,10-20".
#include <filesystem>
#include <string>
#include <vector>

namespace drumlin::particles {

/// The number in a snapshot's name: 12 for snapshots/000012.h5. Throws InputError for another name.
int snapshot_number(const std::filesystem::path& file);

/// Those of a list among the snapshots of the run in `folder`; each once, in order. Throws InputError, naming
/// the option that the list came with, if it cannot be read, or names one that is not there.
std::vector<std::filesystem::path> listed_snapshots(const std::filesystem::path& folder,
                                                    const std::vector<std::filesystem::path>& snapshots,
                                                    const std::string& option, const std::string& list);

}  // namespace drumlin::particles
