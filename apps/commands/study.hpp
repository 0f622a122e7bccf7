#pragma once
// Several folders studied together: what the Python package says of them, with figures and a page.
#include <filesystem>
#include <optional>
#include <vector>

#include "apps/output/results.hpp"

namespace drumlin::apps {

/// `drumlin measure --study`: measured runs over the speed of rotation.
int study(const ResultsRequest& requested, const std::vector<std::filesystem::path>& runs);
/// `drumlin compare --study`: measured runs and flows; each flow judged by `limits` as well.
int compare_study(const ResultsRequest& requested, const std::vector<std::filesystem::path>& folders,
                  const std::optional<std::filesystem::path>& limits);

}  // namespace drumlin::apps
