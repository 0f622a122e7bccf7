#include "coupling/core/results/measured_run.hpp"

#include <fmt/format.h>

#include <tuple>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/run_status.hpp"
#include "coupling/core/files/result_folder.hpp"
#include "coupling/core/results/run_checks.hpp"
#include "coupling/core/results/run_records.hpp"

namespace drumlin {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Problems = std::vector<InputProblem>;

void require_folder(const fs::path& folder) {
  if (!fs::exists(folder)) throw InputError(folder.string() + ": no such folder");
  if (!fs::is_directory(folder)) throw InputError(folder.string() + ": is a file, a run's folder is needed");
}

void check_finished(const fs::path& file) {
  if (!fs::exists(file)) return;
  const std::string status = read_record<RunRecord>(file).status;
  if (status != name_of(RunStatus::finished))
    throw InputError({InputProblem{file.string(), 0, 0, "status",
                                   "the run is unfinished (status " + status + ")", "\"finished\""}});
}

/// Reasons why a run is not steady, in words; none: it is.
std::vector<std::string> reasons_against(const std::optional<SteadinessRecord>& steadiness) {
  if (!steadiness || !steadiness->steady) return {"its measurement does not say whether it is steady"};
  if (*steadiness->steady) return {};
  return steadiness->reasons.empty() ? std::vector<std::string>{"not steady"} : steadiness->reasons;
}

/// What both sides say beside their profiles: one file copied over from elsewhere shows here.
void check_against_header(const fs::path& file, const RunHeader& header, const fs::path& json_file,
                          const SettingsRecord& settings, bool reduced, Problems& problems) {
  if (header.reduced != reduced)
    problems.push_back({file.string(), 0, 0, "reduced",
                        fmt::format("is {}, but {} in {}", header_text(header, "reduced").value_or("missing"),
                                    reduced, json_file.filename().string()),
                        "the same in both files"});
  const auto& [length, time, density] = settings.scales;
  for (const auto& [name, value] :
       {std::pair("length_m", length), {"time_s", time}, {"density_kg_m3", density}})
    if (!(value > 0))
      problems.push_back({json_file.string(), 0, 0, std::string("settings.scales.") + name,
                          fmt::format("is {:g}", value), "a positive number"});
  if (!problems.empty()) return;
  for (const auto& [number, name, value] :
       {std::tuple(&RunHeader::diameter_m, "scales.length_m", std::optional(length)),
        {&RunHeader::rotation, "rotation", settings.rotation.value},
        {&RunHeader::drum_radius, "drum_radius", settings.drum_radius.value},
        {&RunHeader::theta_deg, "frame_angle_deg", settings.frame_angle_deg.value}})
    if (value)
      require_number_near(file, header, number, *value,
                          fmt::format("settings.{} of {}", name, json_file.filename().string()), problems);
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

/// What the calibration leaves open in the scalars of a flow: their half widths.
void add_law_band(ScalarSet& scalars, OrNull<ScalarsRecord> band) {
  if (!band.value) return;
  for (Scalar& scalar : scalars.scalars) {
    const Json& width = band.value->scalars[scalar.name];
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
  return read_record<FlowRecord>(flow_run / "flow.json").missed.value_or(std::vector<std::string>());
}

bool is_flow_run(const fs::path& folder) {
  return fs::exists(folder / "flow.json") || fs::exists(folder / "flow_scene.toml");
}

MeasuredRun read_measured_run(const fs::path& folder, Unsteady unsteady) {
  require_folder(folder);
  check_finished(folder / "run.json");
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
  const auto measured = read_record<MeasuredRecord>(file);
  Problems problems;
  MeasuredRun run{name_of_folder(folder),   folder,           read_profiles(profile_file),         {}, {},
                  measured.settings.scales, measured.reduced, reasons_against(measured.steadiness)};
  for (const ResultFolder* part : {&run_files, &measured_files})
    for (const std::string& edit : accepted_edits(*part)) run.accepted.push_back(edit);
  run.scalars = read_scalars(file, MeasuredRecord::format);
  if (unsteady == Unsteady::refuse)
    for (const std::string& reason : run.unsteady)
      problems.push_back({file.string(), 0, 0, "steadiness", reason,
                          "a steady run, or --accept-unsteady where the command has it"});
  check_frame(profile_file, run.profiles.header, RunSide::particles, problems);
  check_against_header(profile_file, run.profiles.header, file, measured.settings, run.reduced, problems);
  throw_if_any(problems);
  check_layers(profile_file, run.profiles, problems);
  run.slices = slices_below(measured_files, run.profiles, problems);
  run.files = std::move(run_files), run.measured_files = std::move(measured_files);
  throw_if_any(std::move(problems));
  return run;
}

FlowRun read_flow_run(const fs::path& folder, FlowGeometry requested) {
  require_folder(folder);
  const fs::path file = folder / "flow.json", profile_file = folder / "profiles.csv";
  if (!fs::exists(file))
    throw InputError(folder.string() +
                     ": holds no flow.json: no continuum flow, or one that was not finished");
  ResultFolder files = open_flow_run(folder);
  for (const char* name : {"flow.json", "profiles.csv", "flow_scene.toml"}) (void)checked_file(files, name);
  const auto flow = read_record<FlowRecord>(file);
  Problems problems;
  const std::string drum = name_of(Geometry::drum), geometry = flow.geometry.value_or(drum);
  if (requested == FlowGeometry::drum && geometry != drum)
    problems.push_back({file.string(), 0, 0, "geometry", "is " + geometry, "\"drum\""});
  for (const std::string& sentence : limits_missed_by(folder))
    problems.push_back({file.string(), 0, 0, "missed", sentence, "a flow that misses nothing (exit code 0)"});
  throw_if_any(problems);
  FlowRun run{name_of_folder(folder), folder, read_profiles(profile_file), {}, flow.settings.scales,
              flow.reduced,           {},     accepted_edits(files)};
  run.files = std::move(files);
  if (geometry != drum) complete_gap_header(run.profiles.header);
  run.scalars = read_scalars(file, FlowRecord::format);
  add_law_band(run.scalars, flow.law_band);
  check_frame(profile_file, run.profiles.header, RunSide::continuum, problems);
  check_against_header(profile_file, run.profiles.header, file, flow.settings, run.reduced, problems);
  throw_if_any(problems);
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
