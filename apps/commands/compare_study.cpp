// drumlin compare --study: particles and continuum over the speed of rotation.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/support/asked.hpp"
#include "apps/support/commands.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/limits_json.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/paper_data.hpp"
#include "apps/support/pending_figures.hpp"
#include "apps/support/speed_comparison_json.hpp"
#include "apps/support/standard_streams.hpp"
#include "coupling/common/errors.hpp"
#include "coupling/common/text_file.hpp"
#include "coupling/exchange/measured_run.hpp"
#include "coupling/files/field_map_file.hpp"
#include "coupling/study/judged_limits.hpp"
#include "coupling/study/study_run_folder.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Sides {
  std::vector<coupling::StudyRun> particles;
  std::vector<coupling::StudyFlow> flows;
  std::map<std::string, FieldMap> run_maps;  ///< by the name of the run; read for limits alone

  std::vector<std::string> accepted_edits() const {
    std::vector<std::string> edits;
    for (const auto& run : particles) edits.insert(edits.end(), run.accepted.begin(), run.accepted.end());
    for (const auto& flow : flows) edits.insert(edits.end(), flow.accepted.begin(), flow.accepted.end());
    return edits;
  }
};

/// A folder tells by its files which side it is.
Sides read_sides(const std::vector<fs::path>& folders, bool with_run_maps) {
  Sides sides;
  for (const fs::path& folder : folders) {
    if (!fs::is_directory(folder) || !is_flow_run(folder)) {
      sides.particles.push_back(coupling::read_study_run(folder));
      const fs::path measured = folder / "measured";
      if (with_run_maps && fs::exists(measured / "maps.h5"))
        sides.run_maps.emplace(
            sides.particles.back().name,
            read_field_map(checked_file(open_result_folder(measured, WithoutManifest::accept), "maps.h5")));
      continue;
    }
    sides.flows.push_back(coupling::read_study_flow(folder));
    // For the axes of the strain rate at the centre.
    const ResultFolder files = open_flow_run(folder);
    if (fs::exists(folder / "maps.h5"))
      sides.flows.back().side.fields.maps = read_field_map(checked_file(files, "maps.h5"));
  }
  return sides;
}

coupling::JudgedLimits judged(const coupling::Limits& limits, const Sides& sides) {
  std::vector<coupling::JudgedSide> runs, flows;
  for (const coupling::StudyRun& run : sides.particles) {
    runs.push_back({run.name, run.rotation_rpm, {run.profiles, run.scalars, {}}, run.cpu_seconds, ""});
    if (const auto maps = sides.run_maps.find(run.name); maps != sides.run_maps.end())
      runs.back().side.fields.maps = maps->second;
  }
  for (const coupling::StudyFlow& flow : sides.flows)
    flows.push_back({flow.name, flow.rotation_rpm, flow.side, flow.cpu_seconds, flow.start});
  const auto& fitted_on = sides.flows.front().fitted_on;
  return coupling::judged_limits(limits, runs, flows, {fitted_on.begin(), fitted_on.end()});
}

}  // namespace

int compare_study(const CompareStudyOptions& options) {
  const fs::path finished = options.output / "study.json";
  Json inputs = Json::array({options.limits ? input_sum(*options.limits) : ""});
  for (const fs::path& folder : options.folders) inputs.push_back(measured_run_sum(folder));
  const std::string asked = asked_sum(inputs);
  if (options.existing == ExistingOutput::resume && is_complete(finished))
    return done_already(options.output, asked);
  std::optional<coupling::Limits> limits;
  if (options.limits) limits = coupling::read_limits(*options.limits);
  const Sides sides = read_sides(options.folders, limits.has_value());
  const coupling::SpeedComparison comparison =
      coupling::compared_speeds(sides.particles, sides.flows, paper_data_folder());
  StagedOutput output({options.output, options.existing, "compare --study", options.folders, {}, asked});
  const fs::path& folder = output.folder();

  const bool reduced = sides.flows.front().side.profiles.header.reduced.value();
  Json content{{"format", "drumlin-comparison-study-1"},
               {"title", std::string("Particles and continuum over the speed of rotation") +
                             (reduced ? " (reduced)" : "")},
               {"reduced", reduced},
               {"law", Json::parse(sides.flows.front().identity.at("law"))},
               {"effects", sides.flows.front().identity.at("effects")}};
  add_speed_comparison(content, comparison);
  if (limits) content["limits"] = to_json(judged(*limits, sides));
  content["provenance"] = to_json(provenance());
  add_accepted_edits(content["provenance"], sides.accepted_edits());
  replace_file(folder / "table.md", speed_table_markdown(content));
  if (limits) replace_file(folder / "limits.md", limits_markdown(content["limits"]));
  note_pending_figures(folder);
  const fs::path file = folder / "study.json";
  write_json(file, content);
  const FigureScript figures{"speed_comparison_figures.py",
                             {"--study", file.string(), "--output", folder.string()}};
  const auto failures = draw_pending_figures(folder, {figures}, ResultPage{"speed_comparison", file});
  output.publish();
  for (const std::string& warning : comparison.warnings) print_out(fmt::format("warning: {}\n", warning));
  for (const std::string& line : verdict_lines(content)) print_out(fmt::format("{}\n", line));
  if (limits) print_out(limits_markdown(content["limits"]));
  print_out(fmt::format("report: {}\n", fs::absolute(options.output / "index.html").string()));
  throw_if_figures_failed(finished, failures);
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
