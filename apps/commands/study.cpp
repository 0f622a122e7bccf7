// drumlin measure --study, drumlin compare --study, drumlin score: checks the folders, compares their pairs,
// and starts drumlin.study of the Python package, which reads them and writes what they say together.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands/compare_inputs.hpp"
#include "apps/commands/score_fields.hpp"
#include "apps/json/comparison_json.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/commands.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/output/paper_data.hpp"
#include "apps/output/pending_figures.hpp"
#include "apps/process/asked.hpp"
#include "apps/process/program_files.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/document.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// What `drumlin compare` says of two sides; why they cannot be compared is for the study to weigh.
Json compared(const LoadedSide& first, const LoadedSide& second, coupling::Registration by) {
  Json pair{{"first", first.folder.string()}, {"second", second.folder.string()}, {"by", name_of(by)}};
  try {
    add_comparison(pair,
                   coupling::compare(first.compared, second.compared, {.registration = by, .zones = {}}));
  } catch (const InputError& error) {
    pair["refused"] = error.what();
  }
  return pair;
}

double rotation_of(const LoadedSide& side) {
  return side.compared.profiles.header.rotation.value() / side.scales.time_s;
}

/// Each flow against the runs near its speed (the study takes those to 0.5 %) by the axis; for limits by the
/// surface as well, and these runs against one another.
Json compared_pairs(const std::vector<LoadedSide>& sides, bool for_limits) {
  Json pairs = Json::array();
  std::vector<coupling::Registration> registrations{coupling::Registration::axis};
  if (for_limits) registrations.push_back(coupling::Registration::surface);
  for (const LoadedSide& flow : sides) {
    if (flow.kind != RunSide::continuum) continue;
    std::vector<const LoadedSide*> near;
    for (const LoadedSide& run : sides)
      if (run.kind != RunSide::continuum && std::abs(rotation_of(run) / rotation_of(flow) - 1) <= 0.011)
        near.push_back(&run);
    for (const auto by : registrations)
      for (std::size_t i = 0; i < near.size(); ++i) {
        pairs.push_back(compared(*near[i], flow, by));
        for (std::size_t j = i + 1; for_limits && j < near.size(); ++j)
          pairs.push_back(compared(*near[i], *near[j], by));
      }
  }
  return pairs;
}

struct StudyRequest {
  std::vector<fs::path> folders;
  fs::path output;
  ExistingOutput existing;
  bool both_sides;
  std::optional<fs::path> limits;
  FigureScript figures;
  std::string page;
};

/// What the Python module is given. All folders are checked here, as `drumlin compare` does it.
Json given_of(const StudyRequest& request) {
  std::vector<LoadedSide> sides;
  std::vector<std::string> edits;
  Json given{{"both_sides", request.both_sides}, {"runs", Json::array()}, {"flows", Json::array()}};
  for (const fs::path& folder : request.folders) {
    LoadedSide& side = sides.emplace_back(load_side(folder, Unsteady::accept, MovingSnapshots::leave));
    side.compared.fields.slices.clear();
    const bool is_flow = side.kind == RunSide::continuum;
    if (is_flow && !request.both_sides)
      throw InputError(folder.string() + ": is a flow (allowed: measured runs)");
    const fs::path scene = folder / (is_flow ? "flow_scene.toml" : "scene.toml");
    if (fs::exists(scene)) (void)read_toml(scene);
    given[is_flow ? "flows" : "runs"].push_back(folder.string());
    edits.insert(edits.end(), side.accepted.begin(), side.accepted.end());
  }
  if (request.limits) (void)read_toml(*request.limits);
  given["limits"] = request.limits ? Json(request.limits->string()) : Json();
  given["pairs"] = compared_pairs(sides, request.limits.has_value());
  given["provenance"] = to_json(provenance());
  add_accepted_edits(given["provenance"], edits);
  return given;
}

/// Results, figures and page; what the module says comes out when all of it is there.
int carried_out(StudyRequest request) {
  const fs::path finished = request.output / "study.json";
  Json inputs = Json::array();
  if (request.both_sides) inputs.push_back(request.limits ? input_sum(*request.limits) : "");
  for (const fs::path& folder : request.folders) inputs.push_back(measured_run_sum(folder));
  const std::string asked = asked_sum(inputs);
  if (request.existing == ExistingOutput::resume && is_complete(finished))
    return done_already(request.output, asked);
  const Json given = given_of(request);
  StagedOutput output({request.output,
                       request.existing,
                       request.both_sides ? "compare --study" : "study",
                       request.folders,
                       {},
                       asked});
  const fs::path &folder = output.folder(), given_file = folder / "given.json", file = folder / "study.json";
  note_pending_figures(folder);
  write_json(given_file, given);
  const std::string said =
      study_by_script("command.py", {folder.string(), paper_data_folder().string(), given_file.string()});
  fs::remove(given_file);
  auto& words = request.figures.arguments;
  words.insert(words.begin(), folder.string());
  const auto failures = draw_pending_figures(folder, {request.figures}, ResultPage{request.page, file});
  output.publish();
  print_out(said);
  if (request.both_sides)
    print_out(fmt::format("report: {}\n", fs::absolute(request.output / "index.html").string()));
  throw_if_figures_failed(finished, failures);
  return static_cast<int>(ExitCode::done);
}

/// Runs of data/bed in the drum and at the speed of a flow.
std::vector<fs::path> runs_of_the_bed(const RunHeader& flow) {
  std::vector<fs::path> runs;
  const fs::path bed = data_folder() / "bed";
  if (fs::is_directory(bed))
    for (const auto& entry : fs::directory_iterator(bed)) {
      const RunHeader run = read_profiles(entry.path() / "measured" / "profiles.csv").header;
      const auto differ = [&](HeaderNumber number) {
        return std::abs(number_or_nan(run, number) / number_or_nan(flow, number) - 1);
      };
      if (differ(&RunHeader::rotation) <= 0.005 && differ(&RunHeader::drum_radius) <= 1e-3 &&
          differ(&RunHeader::diameter_m) <= 1e-3)
        runs.push_back(entry.path());
    }
  if (runs.empty())
    throw InputError(bed.string() + ": holds no run of this drum at this speed; name some by --against");
  std::sort(runs.begin(), runs.end());
  return runs;
}

}  // namespace

int score(const ScoreOptions& options) {
  Json inputs{input_sum(options.fields), input_sum(options.limits)};
  for (const fs::path& run : options.against) inputs.push_back(measured_run_sum(run));
  const std::string asked = asked_sum(inputs);
  if (options.existing == ExistingOutput::resume && is_complete(options.output / "score.json"))
    return done_already(options.output, asked);
  StagedOutput output(
      {options.output, options.existing, "score", {options.fields, options.limits}, {}, asked});
  const fs::path& folder = output.folder();
  fs::path flow = options.fields;
  if (!fs::is_directory(flow)) write_flow_of_fields(options.fields, flow = folder / "flow");
  const RunHeader header = read_flow_run(flow).profiles.header;
  std::vector<fs::path> sides = options.against.empty() ? runs_of_the_bed(header) : options.against;
  sides.push_back(flow);
  const fs::path given_file = folder / "given.json";
  Json given = given_of({sides, {}, {}, true, options.limits, {}, {}});
  given["scored"] = fs::absolute(options.fields).lexically_normal().filename().string();
  write_json(given_file, given);
  const std::string said =
      study_by_script("command.py", {folder.string(), paper_data_folder().string(), given_file.string()});
  fs::remove(given_file);
  output.publish();
  print_out(said);
  return static_cast<int>(ExitCode::done);
}

int study(const StudyOptions& options) {
  FigureScript figures{"study_figures.py", {paper_data_folder().string()}};
  for (const fs::path& run : options.runs) figures.arguments.push_back(run.string());
  return carried_out({options.runs, options.output, options.existing, false, {}, figures, "study"});
}

int compare_study(const CompareStudyOptions& options) {
  return carried_out({options.folders,
                      options.output,
                      options.existing,
                      true,
                      options.limits,
                      {"speed_comparison_figures.py", {}},
                      "speed_comparison"});
}

}  // namespace drumlin::apps
