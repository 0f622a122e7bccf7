#pragma once
// index.html of a comparison: one file, nothing loaded from elsewhere, no script.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace drumlin::apps {

struct ReportFigure {
  std::filesystem::path png;
  std::string caption;
};

/// Standard base64 with padding (RFC 4648).
std::string base64(const std::string& bytes);

/// The page that shows `comparison` (comparison.json) with the figures inside. Throws InputError if a figure
/// is missing.
std::string report_page(const nlohmann::ordered_json& comparison, const std::vector<ReportFigure>& figures);

}  // namespace drumlin::apps
