#pragma once
// Signs folders that tests make by hand, as the commands sign theirs.
#include <filesystem>
#include <string>

#include "coupling/core/files/manifest.hpp"

namespace drumlin::testing {

/// The manifest of all files that stand in the folder now.
inline void sign(const std::filesystem::path& folder, const std::string& command, bool complete = true) {
  Manifest manifest{.command = command, .complete = complete, .accepted = {}, .files = {}};
  manifest.files = entries_of(folder, files_below(folder));
  write_manifest(folder, manifest);
}

}  // namespace drumlin::testing
