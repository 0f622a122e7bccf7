// drumlin compare --study: particles and continuum over the speed of rotation.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/measured_run.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/paper_data.hpp"
#include "apps/support/speed_comparison_json.hpp"
#include "apps/support/speed_comparison_page.hpp"
#include "apps/support/study_run_folder.hpp"
#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/text_file.hpp"
#include "coupling/files/field_map_file.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Sides {
  std::vector<StudyRun> particles;
  std::vector<StudyFlow> flows;
};

/// A folder tells by its files which side it is.
Sides read_sides(const std::vector<fs::path>& folders) {
  Sides sides;
  for (const fs::path& folder : folders) {
    if (!fs::is_directory(folder) || !is_flow_run(folder)) {
      sides.particles.push_back(read_study_run(folder));
      continue;
    }
    sides.flows.push_back(read_study_flow(folder));
    // For the axes of the strain rate at the centre.
    if (fs::exists(folder / "maps.h5"))
      sides.flows.back().side.fields.maps = read_field_map(folder / "maps.h5");
  }
  return sides;
}

}  // namespace

int compare_study(const CompareStudyOptions& options) {
  const fs::path finished = options.output / "study.json";
  if (options.existing == ExistingOutput::resume && fs::exists(finished)) {
    fmt::print("{}: done already\n", options.output.string());
    return static_cast<int>(ExitCode::done);
  }
  const Sides sides = read_sides(options.folders);
  const SpeedComparison comparison = compared_speeds(sides.particles, sides.flows, paper_data_folder());
  prepare_output(options.output, options.existing, {"study.json", "table.md"}, options.folders);
  fs::create_directories(options.output);

  const bool reduced = sides.flows.front().side.profiles.header.at("reduced") == "true";
  Json content{{"format", "drumlin-comparison-study-1"},
               {"title", std::string("Particles and continuum over the speed of rotation") +
                             (reduced ? " (reduced)" : "")},
               {"reduced", reduced},
               {"law", Json::parse(sides.flows.front().identity.at("law"))},
               {"effects", sides.flows.front().identity.at("effects")}};
  add_speed_comparison(content, comparison);
  content["provenance"] = to_json(provenance());
  replace_file(options.output / "table.md", speed_table_markdown(content));
  // The figures read it under another name: study.json itself says that all is there.
  const fs::path unfinished = options.output / "study.json.part";
  write_json(unfinished, content);
  draw_figures("speed_comparison_figures.py",
               {"--study", unfinished.string(), "--output", options.output.string()});
  replace_file(options.output / "index.html", speed_comparison_page(content, options.output));
  write_json(finished, content);
  fs::remove(unfinished);

  for (const std::string& warning : comparison.warnings) fmt::print("warning: {}\n", warning);
  for (const std::string& line : verdict_lines(content)) fmt::print("{}\n", line);
  fmt::print("report: {}\n", fs::absolute(options.output / "index.html").string());
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
