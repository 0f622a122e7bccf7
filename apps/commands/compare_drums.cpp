// The report of `drumlin compare` on two runs of one drum.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands/compare_overlays.hpp"
#include "apps/commands/compare_record.hpp"
#include "apps/json/comparison_json.hpp"
#include "apps/output/paper_data.hpp"
#include "coupling/comparison/paper_table.hpp"
#include "coupling/comparison/targets.hpp"
#include "coupling/core/documents/json_numbers.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json content_of(const ComparedRuns& runs, const coupling::Comparison& comparison,
                const coupling::Comparison* floor, const coupling::ComparisonOptions& options) {
  const ProfileSet& profiles = runs.first.compared.profiles;
  Json content{{"format", "drumlin-comparison-1"},
               {"title", title_of(runs)},
               {"reduced", profiles.header.reduced.value()}};
  add_comparison(content, comparison, floor);
  const auto speed = coupling::paper_speed_rpm(profiles, paper_data_folder());
  add_paper(
      content, speed,
      speed ? coupling::paper_table(coupling::paper_numbers(paper_data_folder(), *speed), comparison.scalars)
            : std::vector<coupling::PaperRow>());
  add_costs(content, runs);
  content["settings"] = {{"surface_margin", options.zones.surface_margin},
                         {"wall_margin", options.zones.wall_margin},
                         {"register", name_of(options.registration)}};
  add_origins(content, runs);
  return content;
}

// The other flow's errors beside those of the second side, judged as they are.
void add_beside(Json& content, const LoadedSide& beside, const std::vector<coupling::Target>& targets) {
  content["beside"] = {
      {"name", beside.name}, {"kind", name_of(beside.kind)}, {"verdict", counts_of(targets)}};
  for (std::size_t i = 0; i < targets.size(); ++i)
    content["targets"][i]["beside"] = {{"value", number_or_null(targets[i].value)},
                                       {"outcome", name_of(targets[i].outcome)}};
}

/// The scripts read comparison.json and the overlays.
std::vector<FigureScript> figures_of(const ComparedRuns& runs, const fs::path& output, const fs::path& json) {
  std::vector<std::string> words{json.string(), output.string()};
  if (!runs.first.snapshot.empty() && !runs.second.maps_file.empty())
    words.insert(words.end(), {runs.first.snapshot.string(), runs.second.maps_file.string()});
  std::vector<FigureScript> figures{{"compare_figures.py", words}};
  if (runs.first.moving.size() > 1 && !runs.second.maps_file.empty()) {
    figures.push_back({"side_by_side.py", {json.string(), runs.second.maps_file.string(), output.string()}});
    for (const fs::path& file : runs.first.moving) figures.back().arguments.push_back(file.string());
  }
  // They are of full drums, and a reduced run shows no more than that the chain works.
  const bool reduced = runs.first.compared.profiles.header.reduced.value();
  if (const auto costs = cost_data_folder(); costs && !reduced)
    figures.push_back({"report_costs.py", {costs->string(), output.string()}});
  return figures;
}

std::string short_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.3g}", value) : "null";
}

std::string target_summary(const Json& content, const std::vector<coupling::Target>& targets) {
  const Json& counts = content["verdict"];
  std::string text = fmt::format(
      "{}\ntargets: {} met, {} missed, {} not measured; {} judged by the noise floor, the "
      "others by their limits\n",
      content["title"].get<std::string>(), counts["met"].get<int>(), counts["missed"].get<int>(),
      counts["not_measured"].get<int>(), counts["by_noise_floor"].get<int>());
  for (const auto& target : targets)
    if (target.outcome == coupling::Outcome::missed)
      text +=
          fmt::format("  missed: {} {}: {} ({} {} {}) {}\n", target.quantity, target.zone,
                      short_number(target.value), name_of(target.judged_by),
                      short_number(target.judged_by == coupling::JudgedBy::noise_floor ? target.noise_floor
                                                                                       : target.limit),
                      target.measure, target.remark);
  if (content.contains("beside"))
    text += fmt::format("  beside it, {}: {} met, {} missed\n", content["beside"]["name"].get<std::string>(),
                        content["beside"]["verdict"]["met"].get<int>(),
                        content["beside"]["verdict"]["missed"].get<int>());
  return text + unsteady_text(content);
}

}  // namespace

ComparisonReport drum_report(const ComparedRuns& runs, const CompareOptions& options) {
  const coupling::ComparisonOptions how{*enumerator<coupling::Registration>(options.registration), {}};
  coupling::Comparison comparison = compare(runs.first.compared, runs.second.compared, how);
  std::optional<coupling::Comparison> floor;
  if (runs.floor) {
    floor = compare(runs.first.compared, runs.floor->compared, how);
    judge_by_floor(comparison.targets, floor->targets);
  }
  ComparisonReport report{
      std::make_shared<Json>(content_of(runs, comparison, floor ? &*floor : nullptr, how)),
      "comparison",
      "",
      {},
      {}};
  if (runs.beside) {
    coupling::Comparison beside = compare(runs.first.compared, runs.beside->compared, how);
    if (floor) judge_by_floor(beside.targets, floor->targets);
    add_beside(*report.content, *runs.beside, beside.targets);
  }
  report.summary = target_summary(*report.content, comparison.targets);
  report.write_overlays = [&runs, comparison](const fs::path& folder) {
    write_overlays(folder, runs.first.compared, runs.second.compared, comparison);
  };
  report.figures = [&runs](const fs::path& folder, const fs::path& json) {
    return figures_of(runs, folder, json);
  };
  return report;
}

}  // namespace drumlin::apps
