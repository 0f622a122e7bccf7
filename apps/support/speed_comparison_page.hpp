#pragma once
// index.html of `drumlin compare --study`: one file, nothing loaded from elsewhere.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace drumlin::apps {

/// The page that shows `content` (study.json) with the figures of `folder` inside.
std::string speed_comparison_page(const nlohmann::ordered_json& content, const std::filesystem::path& folder);

}  // namespace drumlin::apps
