#include "coupling/core/results/measured_run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/run_status.hpp"
#include "coupling/core/documents/json_document.hpp"
#include "coupling/core/files/result_folder.hpp"
#include "coupling/core/results/run_checks.hpp"

namespace drumlin {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Problems = std::vector<InputProblem>;

void require_folder(const fs::path& folder) {
  if (!fs::exists(folder)) throw InputError(folder.string() + ": no such folder");
  if (!fs::is_directory(folder)) throw InputError(folder.string() + ": is a file, a run's folder is needed");
}

void check_finished(const fs::path& file, Problems& problems) {
  if (!fs::exists(file)) return;
  const Json status = read_json(file, "drumlin-run-1").value("status", Json());
  if (status != name_of(RunStatus::finished))
    problems.push_back({file.string(), 0, 0, "status",
                        "the run is unfinished (status " + plain_text(status) + ")", "\"finished\""});
}

/// Reasons why a run is not steady, in words; none: it is.
std::vector<std::string> reasons_against(const Json& measured) {
  const Json steadiness = measured.value("steadiness", Json());
  if (!steadiness.is_object() || !steadiness.value("steady", Json()).is_boolean())
    return {"its measurement does not say whether it is steady"};
  if (steadiness["steady"].get<bool>()) return {};
  std::vector<std::string> reasons;
  for (const Json& reason : steadiness.value("reasons", Json::array())) reasons.push_back(plain_text(reason));
  if (reasons.empty()) reasons.emplace_back("not steady");
  return reasons;
}

/// What one unit is, of the JSON of either side; reports what is no positive number.
Scales scales_in(const fs::path& file, const Json& settings, Problems& problems) {
  const Json scales = settings.is_object() ? settings.value("scales", Json()) : Json();
  const auto positive = [&](const char* key) {
    const Json value = scales.is_object() ? scales.value(key, Json()) : Json();
    if (value.is_number() && value.get<double>() > 0 && std::isfinite(value.get<double>()))
      return value.get<double>();
    problems.push_back({file.string(), 0, 0, std::string("settings.scales.") + key,
                        value.is_null() ? "is missing" : "is " + plain_text(value), "a positive number"});
    return std::nan("");
  };
  return {positive("length_m"), positive("time_s"), positive("density_kg_m3")};
}

/// Headers against the settings of the JSON beside them: one file copied over from elsewhere shows here.
void check_against_settings(const fs::path& file, const RunHeader& header, const Json& settings,
                            const std::vector<std::pair<HeaderNumber, std::string>>& keys,
                            Problems& problems) {
  for (const auto& [number, setting] : keys) {
    const Json value = settings.is_object() ? settings.value(setting, Json()) : Json();
    if (!value.is_number()) continue;
    require_number_near(file, header, number, value.get<double>(), "settings." + setting, problems);
  }
}

/// The narrow slices, each in the frame and units of the centre.
std::map<double, ProfileSet> slices_below(const ResultFolder& measured, const ProfileSet& centre,
                                          Problems& problems) {
  std::map<double, ProfileSet> slices;
  const fs::path folder = measured.path / "slices";
  if (!fs::is_directory(folder)) return slices;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".csv")
      files.push_back(checked_file(measured, "slices/" + entry.path().filename().string()));
  for (const fs::path& file : files) {
    ProfileSet profiles = read_profiles(file);
    const std::size_t before = problems.size();
    check_frame(file, profiles.header, RunSide::particles, problems);
    if (problems.size() > before) continue;
    for (const HeaderNumber number :
         {&RunHeader::theta_deg, &RunHeader::rotation, &RunHeader::drum_radius, &RunHeader::diameter_m})
      require_number_near(file, profiles.header, number, *(centre.header.*number), "the slice at the centre",
                          problems);
    const double position = *profiles.header.position;
    slices[position] = std::move(profiles);
  }
  return slices;
}

bool reduced_in(const fs::path& file, const Json& json, const fs::path& profile_file, const RunHeader& header,
                Problems& problems) {
  const Json said = json.value("reduced", Json());
  if (!said.is_boolean()) {
    problems.push_back({file.string(), 0, 0, "reduced",
                        said.is_null() ? "is missing" : "is " + plain_text(said), "true or false"});
    return false;
  }
  if (header.reduced != said.get<bool>())
    problems.push_back({profile_file.string(), 0, 0, "reduced",
                        "is " + header_text(header, "reduced").value_or("missing") + ", but " + said.dump() +
                            " in " + file.filename().string(),
                        "the same in both files"});
  return said.get<bool>();
}

/// What the calibration leaves open in the scalars of a flow ("law_band"): their half widths.
void add_law_band(ScalarSet& scalars, const Json& flow) {
  const Json band = flow.value("law_band", Json());
  const Json widths = band.is_object() ? band.value("scalars", Json()) : Json();
  if (!widths.is_object()) return;
  for (Scalar& scalar : scalars.scalars) {
    const Json width = widths.value(scalar.name, Json());
    const Json number = width.is_object() ? width.value("ci99", Json()) : width;
    if (number.is_number()) scalar.ci99 = number.get<double>();
  }
}

/// What a flow across a gap does not have.
void complete_gap_header(RunHeader& header) {
  for (const HeaderNumber number : {&RunHeader::theta_deg, &RunHeader::rotation, &RunHeader::drum_radius})
    if (!(header.*number)) header.*number = 0;
}

void throw_if_any(Problems problems) {
  if (!problems.empty()) throw InputError(std::move(problems));
}

/// A folder that a command has left whole, or files cut out of one.
ResultFolder open_finished(const fs::path& folder, bool cut_out) {
  ResultFolder opened =
      open_result_folder(folder, cut_out ? WithoutManifest::accept : WithoutManifest::refuse);
  if (opened.manifest && !opened.manifest->complete)
    throw InputError(folder.string() + ": is unfinished; call the command that writes it with --resume");
  return opened;
}

}  // namespace

ResultFolder open_flow_run(const fs::path& folder) {
  return open_finished(folder, !fs::exists(folder / "state.h5"));
}

std::string name_of_folder(const fs::path& folder) {
  const fs::path whole = fs::weakly_canonical(folder);
  return whole.has_filename() ? whole.filename().string() : whole.parent_path().filename().string();
}

std::vector<std::string> limits_missed_by(const fs::path& flow_run) {
  std::vector<std::string> missed;
  for (const Json& sentence :
       read_json(flow_run / "flow.json", "drumlin-flow-run-2").value("missed", Json::array()))
    missed.push_back(plain_text(sentence));
  return missed;
}

bool is_flow_run(const fs::path& folder) {
  return fs::exists(folder / "flow.json") || fs::exists(folder / "flow_scene.toml");
}

MeasuredRun read_measured_run(const fs::path& folder, Unsteady unsteady) {
  require_folder(folder);
  Problems problems;
  check_finished(folder / "run.json", problems);
  throw_if_any(problems);
  if (!fs::exists(folder / "measured" / "measured.json"))
    throw InputError(folder.string() + ": has not been measured; run drumlin measure first");
  const bool cut_out = !fs::exists(folder / "log.csv") && !fs::exists(folder / "snapshots");
  ResultFolder run_files = open_finished(folder, cut_out);
  (void)checked_file(run_files, "run.json");
  (void)checked_file(run_files, "scene.toml");
  ResultFolder measured_files = open_finished(folder / "measured", cut_out);
  check_source(measured_files, run_files, fmt::format("drumlin measure {} --overwrite", folder.string()));
  const fs::path file = checked_file(measured_files, "measured.json");
  const fs::path profile_file = checked_file(measured_files, "profiles.csv");
  const Json measured = read_json(file, "drumlin-measured-1");
  MeasuredRun run{name_of_folder(folder), folder, read_profiles(profile_file), {}, {}, {}, false, {}};
  for (const ResultFolder* part : {&run_files, &measured_files})
    for (const std::string& edit : accepted_edits(*part)) run.accepted.push_back(edit);
  run.scalars = read_scalars(file, "drumlin-measured-1");
  run.unsteady = reasons_against(measured);
  if (unsteady == Unsteady::refuse)
    for (const std::string& reason : run.unsteady)
      problems.push_back({file.string(), 0, 0, "steadiness", reason,
                          "a steady run, or --accept-unsteady where the command has it"});
  check_frame(profile_file, run.profiles.header, RunSide::particles, problems);
  const Json settings = measured.value("settings", Json());
  run.scales = scales_in(file, settings, problems);
  run.reduced = reduced_in(file, measured, profile_file, run.profiles.header, problems);
  throw_if_any(problems);
  require_number_near(profile_file, run.profiles.header, &RunHeader::diameter_m, run.scales.length_m,
                      "settings.scales.length_m of measured.json", problems);
  check_against_settings(profile_file, run.profiles.header, settings,
                         {{&RunHeader::rotation, "rotation"},
                          {&RunHeader::drum_radius, "drum_radius"},
                          {&RunHeader::theta_deg, "frame_angle_deg"}},
                         problems);
  check_layers(profile_file, run.profiles, problems);
  run.slices = slices_below(measured_files, run.profiles, problems);
  run.files = std::move(run_files), run.measured_files = std::move(measured_files);
  throw_if_any(std::move(problems));
  return run;
}

FlowRun read_flow_run(const fs::path& folder, FlowGeometry asked) {
  require_folder(folder);
  const fs::path file = folder / "flow.json", profile_file = folder / "profiles.csv";
  if (!fs::exists(file))
    throw InputError(folder.string() +
                     ": holds no flow.json: no continuum flow, or one that was not finished");
  ResultFolder files = open_flow_run(folder);
  for (const char* name : {"flow.json", "profiles.csv", "flow_scene.toml"}) (void)checked_file(files, name);
  const Json flow = read_json(file, "drumlin-flow-run-2");
  Problems problems;
  const Json geometry = flow.value("geometry", Json(name_of(Geometry::drum)));
  const bool is_drum = geometry == name_of(Geometry::drum);
  if (asked == FlowGeometry::drum && !is_drum)
    problems.push_back({file.string(), 0, 0, "geometry", "is " + plain_text(geometry), "\"drum\""});
  for (const std::string& sentence : limits_missed_by(folder))
    problems.push_back({file.string(), 0, 0, "missed", sentence, "a flow that misses nothing (exit code 0)"});
  throw_if_any(problems);
  FlowRun run{name_of_folder(folder), folder, read_profiles(profile_file), {}, {}, false};
  run.accepted = accepted_edits(files);
  run.files = std::move(files);
  if (!is_drum) complete_gap_header(run.profiles.header);
  run.scalars = read_scalars(file, "drumlin-flow-run-2");
  add_law_band(run.scalars, flow);
  check_frame(profile_file, run.profiles.header, RunSide::continuum, problems);
  run.scales = scales_in(file, flow.value("settings", Json()), problems);
  run.reduced = reduced_in(file, flow, profile_file, run.profiles.header, problems);
  throw_if_any(problems);
  require_number_near(profile_file, run.profiles.header, &RunHeader::diameter_m, run.scales.length_m,
                      "settings.scales.length_m of flow.json", problems);
  check_against_settings(profile_file, run.profiles.header, flow.value("settings", Json()),
                         {{&RunHeader::rotation, "rotation"}, {&RunHeader::drum_radius, "drum_radius"}},
                         problems);
  check_layers(profile_file, run.profiles, problems);
  throw_if_any(std::move(problems));
  return run;
}

void require_same_units(const std::vector<MeasuredRun>& runs) {
  Problems problems;
  for (const MeasuredRun& run : runs) {
    const MeasuredRun& first = runs.front();
    const auto differ = [&](const std::string& key, const std::string& ours, const std::string& theirs) {
      problems.push_back({run.name, 0, 0, key, ours + ", but " + theirs + " in " + first.name,
                          "the same units in all runs"});
    };
    const auto compare = [&](const char* key, double Scales::*unit) {
      if (!nearly_equal(run.scales.*unit, first.scales.*unit))
        differ(key, fmt::format("{:.6g}", run.scales.*unit), fmt::format("{:.6g}", first.scales.*unit));
    };
    compare("scales.length_m", &Scales::length_m);
    compare("scales.time_s", &Scales::time_s);
    compare("scales.density_kg_m3", &Scales::density_kg_m3);
    if (run.reduced != first.reduced)
      differ("reduced", run.reduced ? "true" : "false", first.reduced ? "true" : "false");
  }
  throw_if_any(std::move(problems));
}

}  // namespace drumlin
