#pragma once
// What every report of `drumlin compare` says of its two sides: titles, origins, costs.
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "apps/commands/compare.hpp"
#include "apps/commands/compare_inputs.hpp"
#include "apps/output/pending_figures.hpp"

namespace drumlin::apps {

/// Both sides, the run that tells the noise floor, and another flow to be judged beside the second.
struct ComparedRuns {
  LoadedSide first, second;
  std::optional<LoadedSide> floor, beside;
};

/// A report before any of it is written.
struct ComparisonReport {
  std::shared_ptr<nlohmann::ordered_json> content;  ///< comparison.json
  std::string page;                                 ///< template of apps/pages
  std::string summary;                              ///< for the terminal
  std::function<void(const std::filesystem::path& folder)> write_overlays;
  /// The scripts that read comparison.json and the overlays.
  std::function<std::vector<FigureScript>(const std::filesystem::path& folder,
                                          const std::filesystem::path& json)>
      figures;
};

/// Of two drums. Throws InputError unless it is one drum.
ComparisonReport drum_report(const ComparedRuns& runs, const CompareOptions& options);
/// Of two flows in layers. Throws InputError unless geometry, slope, height and grains are the same.
ComparisonReport layer_report(const ComparedRuns& runs, const CompareOptions& options);

/// "Title: particles and continuum (reduced)".
std::string title_of(const ComparedRuns& runs);
/// Keys costs and cost_ratio.
void add_costs(nlohmann::ordered_json& content, const ComparedRuns& runs);
/// Keys particles, continuum, floor, beside where there is one, and provenance.
void add_origins(nlohmann::ordered_json& content, const ComparedRuns& runs);
/// A line for each reason why a side is not steady.
std::string unsteady_text(const nlohmann::ordered_json& content);

}  // namespace drumlin::apps
