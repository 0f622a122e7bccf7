#pragma once
// The result folders within a folder.
#include <filesystem>
#include <vector>

namespace drumlin::apps {

/// The inner ones first: their files are none of the outer one; last the folder itself. Links are not
/// followed, nor what a command that was killed has left.
std::vector<std::filesystem::path> result_folders(const std::filesystem::path& folder);

}  // namespace drumlin::apps
