#pragma once
// index.html of a study: one file, nothing loaded from elsewhere, no script.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace drumlin::apps {

/// The page that shows `study` (study.json): warnings, the paper's table, the laws, and the figures that
/// `folder`/figures.json lists (file, title, "paper says", "we find"), with the figures inside. Throws
/// InputError if the list or a figure is missing.
std::string study_page(const nlohmann::ordered_json& study, const std::filesystem::path& folder);

}  // namespace drumlin::apps
