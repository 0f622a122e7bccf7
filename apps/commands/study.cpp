// drumlin measure --study, drumlin compare --study, drumlin score: checks the folders, compares their pairs,
// and starts drumlin.study of the Python package, which reads them and writes what they say together.
#include "apps/commands/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/command_line/command.hpp"
#include "apps/commands/compare_inputs.hpp"
#include "apps/commands/score_fields.hpp"
#include "apps/json/comparison_json.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/paper_data.hpp"
#include "apps/output/pending_figures.hpp"
#include "apps/process/program_files.hpp"
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
  given["provenance"] = provenance();
  add_accepted_edits(given["provenance"], edits);
  return given;
}

/// Has the module write what the folders say together; what it says of it.
std::string studied(const Json& given, const fs::path& folder) {
  const fs::path file = folder / "given.json";
  write_json(file, given);
  const std::string said =
      output_of_script("../study/command.py", {folder.string(), paper_data_folder().string(), file.string()});
  fs::remove(file);
  return said;
}

/// Results, figures and page; what the module says comes out when all of it is there.
int carried_out(const ResultsRequest& requested, StudyRequest request) {
  return make_results(requested, [&](Results& results) -> Made {
    const Json given = given_of(request);
    const fs::path& folder = results.begin();
    note_pending_figures(folder);
    std::string said = studied(given, folder);
    auto& words = request.figures.arguments;
    words.insert(words.begin(), folder.string());
    if (request.both_sides)
      said += fmt::format("report: {}\n", fs::absolute(requested.folder / "index.html").string());
    return {said,
            draw_pending_figures(folder, {request.figures}, ResultPage{request.page, folder / "study.json"})};
  });
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

struct ScoreOptions {
  fs::path fields, limits;
  std::vector<fs::path> against;  ///< empty: those of data/bed at that speed
  fs::path output;
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.add("fields", fields, "FIELDS",
          "Folder of a continuum flow; profiles.csv or maps.h5 of one; or another program's fields in CSV "
          "(docs/formats/score.md)")
        .required();
    d.add("--limits", limits, "LIMITS.toml", "Limits, as data/limits/bed.toml").required();
    d.add("--against", against, "RUN",
          "Measured runs of that drum at that speed; those of data/bed unless told")
        .decides(Decides::measured);
    d.output(output, "SCORE", "Folder for score.json and score.md");
    d.existing(existing);
  }
};

int score(const ScoreOptions& options) {
  return make_results(
      results_of(options, "score", options.output, "score.json"), [&](Results& results) -> Made {
        const fs::path& folder = results.begin();
        fs::path flow = options.fields;
        if (!fs::is_directory(flow)) write_flow_of_fields(options.fields, flow = folder / "flow");
        const RunHeader header = read_flow_run(flow).profiles.header;
        std::vector<fs::path> sides = options.against.empty() ? runs_of_the_bed(header) : options.against;
        sides.push_back(flow);
        Json given = given_of({sides, true, options.limits, {}, {}});
        given["scored"] = fs::absolute(options.fields).lexically_normal().filename().string();
        return {studied(given, folder)};
      });
}

}  // namespace

int study(const ResultsRequest& requested, const std::vector<fs::path>& runs) {
  FigureScript figures{"study_figures.py", {paper_data_folder().string()}};
  for (const fs::path& run : runs) figures.arguments.push_back(run.string());
  return carried_out(requested, {runs, false, {}, figures, "study"});
}

int compare_study(const ResultsRequest& requested, const std::vector<fs::path>& folders,
                  const std::optional<fs::path>& limits) {
  return carried_out(requested,
                     {folders, true, limits, {"speed_comparison_figures.py", {}}, "speed_comparison"});
}

Command score_command() {
  return command("score", "Errors of any continuum of a drum against the particles, beside their limits",
                 score);
}

}  // namespace drumlin::apps
