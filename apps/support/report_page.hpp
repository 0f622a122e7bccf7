#pragma once
// index.html of a comparison: one file, nothing loaded from elsewhere, no script.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace drumlin::apps {

/// Where a figure stands on the page.
enum class ReportSection { maps, centre, slices, costs };

struct ReportFigure {
  std::filesystem::path png;
  std::string caption;  ///< plain text: what it shows and how to read it
  ReportSection section = ReportSection::centre;
};

/// Standard base64 with padding (RFC 4648).
std::string base64(const std::string& bytes);

/// Those of the figures that compare_figures.py knows how to draw and that lie in the folder, with their
/// captions, in the order of the page.
std::vector<ReportFigure> figures_in(const std::filesystem::path& folder);

/// The page that shows `comparison` (comparison.json) with the figures inside. Throws InputError if a figure
/// is missing.
std::string report_page(const nlohmann::ordered_json& comparison, const std::vector<ReportFigure>& figures);

}  // namespace drumlin::apps
