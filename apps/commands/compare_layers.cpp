// The report of `drumlin compare` on two flows in layers.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/commands/compare_record.hpp"
#include "apps/json/comparison_json.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string percent(const Json& value) {
  return value.is_number() ? fmt::format("{:.1f} %", 100 * value.get<double>()) : "-";
}

std::string layer_summary(const Json& content) {
  std::string text = fmt::format("{}\nrelative errors, rms over the layers (bulk; from base to top)\n",
                                 content["title"].get<std::string>());
  for (const auto& [field, zones] : content["errors"].items())
    if (!zones.is_null())
      text += fmt::format("  {:<10}  {:>8}  {:>8}{}\n", field, percent(zones["bulk"]["rel_l2"]),
                          percent(zones["all"]["rel_l2"]),
                          zones["bulk"].contains("floor_rel_l2")
                              ? fmt::format("   noise floor {}", percent(zones["bulk"]["floor_rel_l2"]))
                              : "");
  return text + unsteady_text(content);
}

}  // namespace

ComparisonReport layer_report(const ComparedRuns& runs, const CompareOptions& options) {
  const auto by = *enumerator<coupling::Registration>(options.registration);
  const coupling::LayerOptions how;
  const coupling::LayerComparison comparison =
      coupling::compare_layers(runs.first.compared, runs.second.compared, by, how);
  std::optional<coupling::LayerComparison> floor;
  if (runs.floor) floor = coupling::compare_layers(runs.first.compared, runs.floor->compared, by, how);

  ComparisonReport report;
  const ProfileSet& profiles = runs.first.compared.profiles;
  Json content{{"format", "drumlin-layer-comparison-1"},
               {"title", title_of(runs)},
               {"reduced", profiles.header.reduced.value()}};
  add_layer_comparison(content, comparison, floor ? &*floor : nullptr);
  add_costs(content, runs);
  content["settings"] = {{"wall_margin", how.wall_margin}, {"top_margin", how.top_margin}};
  add_origins(content, runs);
  report.page = "layer_comparison";
  report.summary = layer_summary(content);
  report.content = std::make_shared<Json>(std::move(content));
  report.write_overlays = [overlay = coupling::layer_overlay(comparison, profiles)](const fs::path& folder) {
    write_profiles(folder / "overlay.csv", overlay);
  };
  report.figures = [snapshot = runs.first.snapshot](const fs::path& folder, const fs::path& json) {
    std::vector<std::string> words{json.string(), folder.string()};
    if (!snapshot.empty()) words.push_back(snapshot.string());
    return std::vector<FigureScript>{{"layer_comparison_figures.py", words}};
  };
  return report;
}

}  // namespace drumlin::apps
