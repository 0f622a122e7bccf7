// drumlin measure --study: several measured runs together, laws over speed, the paper's table.
#include "coupling/study/study.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/commands.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/paper_data.hpp"
#include "apps/support/study_json.hpp"
#include "apps/support/study_page.hpp"
#include "coupling/exchange/document.hpp"
#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/text_file.hpp"
#include "coupling/exchange/toml_text.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Settings of a measurement that must be the same in all runs; the others are results (the angle of the
/// frame, say).
constexpr const char* compared_settings[] = {
    "slope_isoline_nu",      "slope_half_width_asked", "surface_nu",      "position",
    "slice_width_asked",     "layer_thickness",        "velocity_window", "surface_speed_depth",
    "linear_share",          "decay_window_below_H",   "bulk_margin",     "mu_fit_I",
    "mu_fit_surface_margin", "mu_fit_wall_margin"};

std::string text_of(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

/// Name of a run's folder, also for "." or a path that ends in "/".
std::string name_of_run(const fs::path& run) {
  const fs::path whole = fs::weakly_canonical(run);
  return whole.has_filename() ? whole.filename().string() : whole.parent_path().filename().string();
}

/// Grains, walls and effects of the scene must agree, the numerics need not. A run from elsewhere has no
/// scene.
void add_scene(StudyRun& run, const fs::path& file) {
  if (!fs::exists(file)) return;
  const Document scene = read_toml(file);
  for (const char* part : {"grains", "effects"})
    if (const Node* node = scene.root.find(part)) run.identity[part] = toml_text(*node);
  if (const Node* solver = scene.root.find("solver"))
    if (const Node* tolerance = solver->find("tolerance"))
      run.numerics["solver.tolerance"] = toml_value(*tolerance);
  const Node* stages = scene.root.find("stages");
  const auto* all = stages == nullptr ? nullptr : std::get_if<Node::Array>(&stages->value);
  if (all != nullptr && !all->empty())
    if (const Node* step = all->back().find("time_step_s")) run.numerics["time_step_s"] = toml_value(*step);
}

void add_warnings(StudyRun& run, const Json& measured) {
  const Json steadiness = measured.value("steadiness", Json());
  if (!steadiness.is_object() || steadiness.value("steady", true)) return;
  for (const Json& reason : steadiness.value("reasons", Json::array()))
    run.warnings.push_back(text_of(reason));
  if (run.warnings.empty()) run.warnings.push_back("not steady");
}

/// Profiles whose header holds numbers where the study reads some.
ProfileSet checked_profiles(const fs::path& file) {
  ProfileSet profiles = read_profiles(file);
  for (const char* key :
       {"wall_z", "rotation", "drum_radius", "diameter_m", "theta_deg", "interval_factor", "position"}) {
    const auto found = profiles.header.find(key);
    if (found == profiles.header.end()) continue;
    double number = 0;
    const char* end = found->second.data() + found->second.size();
    const auto read = std::from_chars(found->second.data(), end, number);
    if (read.ec != std::errc() || read.ptr != end)
      throw InputError({InputProblem{file.string(), 0, 0, key, found->second + " is no number", "a number"}});
  }
  return profiles;
}

/// Profiles of the narrow slices, where the measurement left them.
void add_slices(StudyRun& run, const fs::path& folder) {
  if (!fs::is_directory(folder)) return;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".csv") continue;
    ProfileSet profiles = checked_profiles(entry.path());
    const auto position = profiles.header.find("position");
    if (position == profiles.header.end())
      throw InputError(
          {InputProblem{entry.path().string(), 0, 0, "position", "is missing", "x of the slice"}});
    run.slices[std::stod(position->second)] = std::move(profiles);
  }
}

StudyRun read_run(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw InputError(folder.string() + ": no such folder");
  if (fs::exists(folder / "run.json")) {
    const Json status = read_json(folder / "run.json", "drumlin-run-1").value("status", Json());
    if (status != "finished")
      throw InputError(fmt::format("{}: the run is unfinished (status {})", folder.string(), status.dump()));
  }
  const fs::path file = folder / "measured" / "measured.json";
  if (!fs::exists(file))
    throw InputError(folder.string() + ": has not been measured; run drumlin measure first");
  const Json measured = read_json(file, "drumlin-measured-1");
  const Json settings = measured.value("settings", Json::object());
  StudyRun run;
  run.name = name_of_run(folder);
  run.profiles = checked_profiles(folder / "measured" / "profiles.csv");
  run.scalars = read_scalars(file, "drumlin-measured-1");
  const Json time = settings.value("scales", Json::object()).value("time_s", Json());
  const Json rotation = settings.value("rotation", Json());
  if (time.is_number() && rotation.is_number())
    run.rotation_rpm = rotation.get<double>() / time.get<double>() * 30 / std::numbers::pi;
  for (const char* key : {"reduced", "drum_radius", "diameter_m"}) {
    const auto found = run.profiles.header.find(key);
    if (found != run.profiles.header.end()) run.identity[key] = found->second;
  }
  for (const char* key : compared_settings)
    if (settings.contains(key)) run.identity[std::string("settings.") + key] = text_of(settings[key]);
  add_scene(run, folder / "scene.toml");
  add_warnings(run, measured);
  add_slices(run, folder / "measured" / "slices");
  return run;
}

void print_study(const Study& study, const Json& content) {
  for (const std::string& warning : study.warnings) fmt::print("warning: {}\n", warning);
  fmt::print("\nlaws over the speed of rotation (99 %)\n");
  for (const SpeedLaw& law : study.laws) {
    fmt::print("  {:28} {}\n", law.name, law.formula);
    for (const auto& c : law.coefficients)
      fmt::print("  {:28}   {} = {:.4g} +- {:.2g}\n", "", c.name, c.value, c.ci99);
  }
  for (const Collapse& collapse : study.collapses)
    fmt::print("  {:28} spread between speeds / intervals = {:.2f} (limit {:.2f}): {}\n",
               collapse.column + "(I)", collapse.ratio, collapse.limit,
               collapse.collapse ? "one curve" : "not one curve");
  fmt::print("\n{}\n", paper_table_markdown(study));
  if (!study.paper.empty())
    fmt::print("{} agree, {} near, {} differ, {} not measured\n", content["verdict"]["agrees"].get<int>(),
               content["verdict"]["near"].get<int>(), content["verdict"]["differs"].get<int>(),
               content["verdict"]["not measured"].get<int>());
}

}  // namespace

int study(const StudyOptions& options) {
  const fs::path finished = options.output / "study.json";
  if (options.existing == ExistingOutput::resume && fs::exists(finished)) {
    fmt::print("{}: done already\n", options.output.string());
    return static_cast<int>(ExitCode::done);
  }
  std::vector<StudyRun> runs;
  std::vector<std::string> folders;
  for (const fs::path& run : options.runs) {
    runs.push_back(read_run(run));
    folders.push_back(run.string());
  }
  const Study result = study_of(std::move(runs), paper_data_folder());
  prepare_output(options.output, options.existing, {"study.json", "paper_table.md"}, options.runs);
  fs::create_directories(options.output);

  const bool reduced = result.runs.front().identity.at("reduced") == "true";
  Json content{{"format", "drumlin-study-1"}, {"reduced", reduced}};
  add_study(content, result);
  content["provenance"] = to_json(provenance());
  const std::string table = paper_table_markdown(result);
  replace_file(options.output / "paper_table.md", table);
  // The figures read it under another name: study.json itself says that all is there.
  const fs::path unfinished = options.output / "study.json.part";
  write_json(unfinished, content);
  std::vector<std::string> words{"--study",  unfinished.string(),    "--paper", paper_data_folder().string(),
                                 "--output", options.output.string()};
  words.insert(words.end(), folders.begin(), folders.end());
  draw_figures("study_figures.py", words);
  replace_file(options.output / "index.html", study_page(content, options.output));
  write_json(finished, content);
  fs::remove(unfinished);
  print_study(result, content);
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
