#pragma once
#include <filesystem>
#include <optional>

namespace drumlin::apps {

/// The folder data/paper: the numbers of the paper.
std::filesystem::path paper_data_folder();

/// The folder data/cost beside it: what accuracy and effects cost, as it was recorded; nothing where the
/// program stands alone.
std::optional<std::filesystem::path> cost_data_folder();

}  // namespace drumlin::apps
