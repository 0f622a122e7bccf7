// drumlin compare: two runs of one drum side by side, particles and continuum as a rule.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/commands/compare_inputs.hpp"
#include "apps/commands/compare_overlays.hpp"
#include "apps/support/commands.hpp"
#include "apps/support/comparison_json.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/paper_data.hpp"
#include "apps/support/pending_figures.hpp"
#include "apps/support/standard_streams.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/comparison/paper_table.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Both sides, and the run that tells the noise floor.
struct Inputs {
  LoadedSide first, second;
  std::optional<LoadedSide> floor;
};

Inputs read_inputs(const CompareOptions& options) {
  const Unsteady unsteady = options.accept_unsteady ? Unsteady::accept : Unsteady::refuse;
  Inputs inputs{load_side(options.run, unsteady), load_side(options.flow_run, unsteady), std::nullopt};
  require_same_scales(inputs.first, inputs.second);
  if (options.floor) {
    inputs.floor = load_side(*options.floor, unsteady);
    require_same_scales(inputs.first, *inputs.floor);
  }
  return inputs;
}

Json entry(const Json& object, const std::string& key) {
  return object.is_object() ? object.value(key, Json()) : Json();
}

Json header_of(const ProfileSet& profiles) {
  Json header;
  for (const auto& [key, value] : header_texts(profiles.header)) header[key] = value;
  return header;
}

/// What a side is and where it comes from.
Json origin_of(const LoadedSide& side) {
  Json origin{{"kind", side.kind}, {"name", side.name}, {"profiles", header_of(side.compared.profiles)}};
  if (!side.unsteady.empty()) origin["unsteady"] = side.unsteady;
  const Json records = records_of(side);
  origin["run"] = entry(records, "run");
  origin["measurement"] = entry(entry(records, "measured"), "settings");
  origin["flow"] = entry(records, "flow");
  return origin;
}

/// Seconds of a side: how long until its results stood there, and on how much of a processor.
Json seconds_of(const LoadedSide& side) {
  const Json records = records_of(side);
  if (side.kind == "continuum")
    return {{"wall", entry(entry(records, "flow"), "seconds")},
            {"processor", entry(entry(records, "flow"), "cpu_seconds")},
            {"measurement", nullptr}};
  return {{"wall", entry(entry(records, "run"), "wall_seconds")},
          {"processor", entry(entry(records, "run"), "cpu_seconds")},
          {"measurement", entry(entry(records, "measured"), "seconds")}};
}

Json ratio(const Json& above, const Json& below) {
  if (!above.is_number() || !below.is_number() || !(below.get<double>() > 0)) return nullptr;
  return above.get<double>() / below.get<double>();
}

void add_costs(Json& content, const Inputs& inputs) {
  const Json first = seconds_of(inputs.first), second = seconds_of(inputs.second);
  content["costs"] = {{inputs.first.kind + " run, wall", first["wall"]},
                      {inputs.first.kind + " run, processor", first["processor"]},
                      {"measurement, wall", first["measurement"]},
                      {inputs.second.kind + " solve, wall", second["wall"]},
                      {inputs.second.kind + " solve, processor", second["processor"]}};
  content["cost_ratio"] = {{"wall", ratio(first["wall"], second["wall"])},
                           {"processor", ratio(first["processor"], second["processor"])}};
}

std::string title_of(const Inputs& inputs) {
  Json title = entry(entry(records_of(inputs.first), "run"), "title");
  if (!title.is_string()) title = inputs.first.name;
  const bool reduced = inputs.first.compared.profiles.header.reduced.value();
  return fmt::format("{}: {} and {}{}", title.get<std::string>(), inputs.first.kind, inputs.second.kind,
                     reduced ? " (reduced)" : "");
}

Json content_of(const Inputs& inputs, const coupling::Comparison& comparison,
                const coupling::Comparison* floor, const coupling::ComparisonOptions& options) {
  const ProfileSet& profiles = inputs.first.compared.profiles;
  Json content{{"format", "drumlin-comparison-1"},
               {"title", title_of(inputs)},
               {"reduced", profiles.header.reduced.value()}};
  add_comparison(content, comparison, floor);
  const auto speed = coupling::paper_speed_rpm(profiles, paper_data_folder());
  add_paper(
      content, speed,
      speed ? coupling::paper_table(coupling::paper_numbers(paper_data_folder(), *speed), comparison.scalars)
            : std::vector<coupling::PaperRow>());
  add_costs(content, inputs);
  content["settings"] = {{"surface_margin", options.zones.surface_margin},
                         {"wall_margin", options.zones.wall_margin},
                         {"register", name_of(options.registration)}};
  content["particles"] = origin_of(inputs.first);
  content["continuum"] = origin_of(inputs.second);
  content["floor"] = inputs.floor ? Json{{"name", inputs.floor->name}, {"kind", inputs.floor->kind}} : Json();
  content["provenance"] = to_json(provenance());
  std::vector<std::string> edits = inputs.first.accepted;
  edits.insert(edits.end(), inputs.second.accepted.begin(), inputs.second.accepted.end());
  if (inputs.floor) edits.insert(edits.end(), inputs.floor->accepted.begin(), inputs.floor->accepted.end());
  add_accepted_edits(content["provenance"], edits);
  return content;
}

/// The scripts read comparison.json and the overlays.
std::vector<FigureScript> figures_of(const Inputs& inputs, const fs::path& output, const fs::path& json) {
  std::vector<std::string> words{"--comparison", json.string(), "--output", output.string()};
  if (!inputs.first.snapshot.empty()) {
    words.insert(words.end(), {"--snapshot", inputs.first.snapshot.string()});
    if (!inputs.second.maps_file.empty())
      words.insert(words.end(), {"--maps", inputs.second.maps_file.string()});
  }
  std::vector<FigureScript> figures{{"compare_figures.py", words}};
  // They are of full drums, and a reduced run shows no more than that the chain works.
  const bool reduced = inputs.first.compared.profiles.header.reduced.value();
  if (!reduced && fs::is_directory(cost_data_folder()))
    figures.push_back({"report_costs.py", {cost_data_folder().string(), output.string()}});
  return figures;
}

std::string short_number(const Json& value) {
  return value.is_number() ? fmt::format("{:.3g}", value.get<double>()) : value.dump();
}

std::string summary_of(const Json& content) {
  const Json& counts = content["verdict"];
  std::string text =
      fmt::format("{}\ntargets: {} met, {} missed, {} not measured\n", content["title"].get<std::string>(),
                  counts["met"].get<int>(), counts["missed"].get<int>(), counts["not_measured"].get<int>());
  for (const auto& target : content["targets"])
    if (target["outcome"] == "missed")
      text += fmt::format("  missed: {} {}: {} (limit {} {}) {}\n", target["quantity"].get<std::string>(),
                          target.value("zone", std::string()), short_number(target["value"]),
                          short_number(target["limit"]), target["measure"].get<std::string>(),
                          target.value("remark", std::string()));
  for (const char* side : {"particles", "continuum"})
    for (const Json& reason : content[side].value("unsteady", Json::array()))
      text += fmt::format("  not steady: {}: {}\n", content[side]["name"].get<std::string>(),
                          reason.get<std::string>());
  return text;
}

}  // namespace

int compare(const CompareOptions& options) {
  const fs::path finished = options.output / "comparison.json";
  if (options.existing == ExistingOutput::resume && is_complete(finished)) {
    print_out(fmt::format("{}: done already\n", options.output.string()));
    return static_cast<int>(ExitCode::done);
  }
  const Inputs inputs = read_inputs(options);
  const coupling::ComparisonOptions how{
      options.registration == "surface" ? coupling::Registration::surface : coupling::Registration::axis, {}};
  const coupling::Comparison comparison = compare(inputs.first.compared, inputs.second.compared, how);
  std::optional<coupling::Comparison> floor;
  if (inputs.floor) floor = compare(inputs.first.compared, inputs.floor->compared, how);
  const Json content = content_of(inputs, comparison, floor ? &*floor : nullptr, how);

  std::vector<fs::path> read{options.run, options.flow_run};
  if (options.floor) read.push_back(*options.floor);
  StagedOutput output({options.output, options.existing, "compare", read});
  const fs::path& folder = output.folder();
  write_overlays(folder, inputs.first.compared, inputs.second.compared, comparison);
  note_pending_figures(folder);
  const fs::path file = folder / "comparison.json";
  write_json(file, content);
  const auto failures =
      draw_pending_figures(folder, figures_of(inputs, folder, file), ResultPage{"comparison", file});
  output.publish();
  print_out(fmt::format("{}report: {}\n", summary_of(content),
                        fs::absolute(options.output / "index.html").string()));
  throw_if_figures_failed(finished, failures);
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
