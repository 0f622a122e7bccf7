// drumlin measure: profiles and scalars of a finished particle run.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/commands.hpp"
#include "apps/commands/accuracy_statement.hpp"
#include "apps/commands/measure/content.hpp"
#include "apps/commands/measure/part.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/progress.hpp"
#include "coupling/calibration/log_friction.hpp"
#include "coupling/exchange/errors.hpp"
#include "coupling/exchange/text_file.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/measurement/measurement.hpp"
#include "particles/measurement/run_log.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double narrow_slice_width = 2;  // d, as the paper's five slices

std::string trimmed(std::string text) {
  text.erase(text.find_last_not_of(' ') + 1);
  return text;
}

Json finished_run(const fs::path& run) {
  if (!fs::is_directory(run)) throw InputError(run.string() + ": no such folder");
  if (!fs::exists(run / "run.json"))
    throw InputError(run.string() + ": holds no run.json, so no particle run");
  const Json json = read_json(run / "run.json", "drumlin-run-1");
  const Json status = json.value("status", Json());
  if (status != "finished")
    throw InputError(
        fmt::format("{}: the run is unfinished (status {}); continue it with drumlin run --resume",
                    run.string(), status.dump()));
  return json;
}

MeasurementOptions settings_for(const MeasureOptions& options) {
  MeasurementOptions settings;
  settings.position = options.position;
  settings.slice_width = options.slice_width;
  settings.layer_thickness = options.layer_thickness;
  if (names_part(options, "gradients")) settings.gradient_step = options.gradient_step;
  if (names_part(options, "slices")) settings.slices = SlicesRequest{options.slices, narrow_slice_width};
  settings.sensitivity = names_part(options, "sensitivity");
  settings.voronoi = names_part(options, "voronoi");
  return settings;
}

/// slices/NAME.csv for each slice, and what was read off it.
void write_slices(const fs::path& folder, const Measurement& measured, const MeasurementOptions& settings,
                  const std::map<std::string, std::string>& header, Json& content) {
  if (measured.slices.empty()) return;
  fs::create_directories(folder / "slices");
  Json list = Json::array();
  for (const MeasuredSlice& slice : measured.slices) {
    ProfileSet profiles = slice.profiles;
    profiles.header = header;
    profiles.header["position"] = fmt::format("{}", slice.position);
    profiles.header["slice_width"] = fmt::format("{}", slice.width);
    profiles.header["axis_depth"] = fmt::format("{}", slice.axis_depth);
    profiles.header["wall_z"] = fmt::format("{}", slice.wall_z);
    const std::string file = fmt::format("slices/x{:+.1f}.csv", slice.position);
    write_profiles(folder / file, profiles);
    const ProfileScalars fits = profile_scalars(profiles, settings.scalars);
    Json entry{{"position", slice.position}, {"width", slice.width}, {"file", file}};
    add_scalars(entry, {{{"surface_speed", fits.surface_speed, {}},
                         {"shear_rate", fits.shear_rate, {}},
                         {"H", fits.H, {}},
                         {"lambda", fits.lambda, {}},
                         {"Q", fits.Q, {}},
                         {"axis_depth", slice.axis_depth, {}}}});
    list.push_back(entry);
  }
  content["slices"] = list;
}

/// series.csv: one line per snapshot.
void write_series(const fs::path& file, const TimeSeries& series) {
  std::string text = "# drumlin-series-1\ntime,turns,kinetic_energy,theta_com_deg\n";
  for (std::size_t s = 0; s < series.time.size(); ++s)
    text += fmt::format("{},{},{},{}\n", series.time[s], series.wall_angle[s] / (2 * std::numbers::pi),
                        series.kinetic_energy[s],
                        series.mass_angle.empty()
                            ? std::string()
                            : fmt::format("{}", series.mass_angle[s] * 180 / std::numbers::pi));
  replace_file(file, text);
}

void print_scalar(const Scalar& scalar, const ScalarSensitivity& sensitivity) {
  const std::string value =
      std::isfinite(scalar.value) ? fmt::format("{:.4g}", scalar.value) : "not measured";
  const bool known = scalar.ci99 && std::isfinite(*scalar.ci99);
  const std::string windows = sensitivity.changes.empty()
                                  ? ""
                                  : fmt::format("{:.4g} ... {:.4g}, most by {}", sensitivity.lowest,
                                                sensitivity.highest, sensitivity.strongest);
  fmt::print("{}\n", trimmed(fmt::format("  {:32} {:>12} {:12} {}", scalar.name, value,
                                         known ? fmt::format("+- {:.2g}", *scalar.ci99) : "", windows)));
}

/// What is known beside the intervals; nothing of another program's run.
std::optional<AccuracyStatement> statement_of(const MeasureOptions& options, const Json& run,
                                              const Measurement& measured, const ScalarSet& scalars) {
  if (run.value("imported", false) || !fs::exists(options.run / "scene.toml")) return std::nullopt;
  const Scene scene = read_scene(options.run / "scene.toml");
  const auto record = options.accuracy ? accuracy_record(*options.accuracy, scene) : shipped_record(scene);
  const double snapshots = static_cast<double>(measured.series.time.size());
  const double both_ends =
      snapshots > 1 ? snapshots / (snapshots - 1) : 1;  // each snapshot stands for a stretch
  const double sampled = both_ends * (measured.last_time() - measured.first_time()) * measured.scales.time_s;
  const double turned = measured.series.wall_angle.empty()
                            ? 0
                            : measured.series.wall_angle.back() - measured.series.wall_angle.front();
  const RunCost cost{.cpu_seconds = run.value("cpu_seconds", 0.0),
                     .simulated_seconds = run.value("simulated_seconds", 0.0),
                     .sampled_seconds = sampled,
                     .turns = both_ends * std::abs(turned) / (2 * std::numbers::pi)};
  ScalarSet with_intervals;
  for (const Scalar& scalar : scalars.scalars)
    if (scalar.ci99 && std::isfinite(scalar.value)) with_intervals.scalars.push_back(scalar);
  return accuracy_statement(scene, record, with_intervals, cost);
}

void print_steadiness(const Steadiness& steadiness) {
  fmt::print("{}", steadiness.steady ? "steady" : "NOT STEADY, or too short to say:");
  for (const std::string& reason : steadiness.reasons) fmt::print("\n  - {}", reason);
  if (std::isfinite(steadiness.energy.value))
    fmt::print("{}energy {:+.1f} +- {:.1f} % from the first half to the second",
               steadiness.steady ? ": " : "\n  ", 100 * steadiness.energy.value,
               100 * steadiness.energy.ci99);
  if (std::isfinite(steadiness.slope_deg.value))
    fmt::print(", slope {:+.2f} +- {:.2f} deg", steadiness.slope_deg.value, steadiness.slope_deg.ci99);
  fmt::print("\n");
}

}  // namespace

int measure(const MeasureOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check_parts(options.parts);
  const fs::path folder = options.run / "measured", finished = folder / "measured.json";
  if (options.existing == ExistingOutput::resume && fs::exists(finished)) {
    fmt::print("{}: done already\n", folder.string());
    return static_cast<int>(ExitCode::done);
  }
  const Json run = finished_run(options.run);
  const bool reduced = run.value("reduced", false);
  const auto files = snapshot_files(options.run);
  if (files.empty())
    throw InputError(options.run.string() + ": holds no snapshots: there is nothing to measure");
  prepare_output(folder, options.existing, {"measured.json", "profiles.csv"});

  const MeasurementOptions settings = settings_for(options);
  const LayerSelection selection;
  const std::vector<Part> parts = reading_parts(options);
  std::vector<MeasurementPart> readers;
  for (const Part& part : parts) readers.push_back(part.reading);
  const SnapshotSource source{files.size(), [&](std::size_t i) { return read_snapshot(files[i]); }};
  Progress progress;
  Measurement measured = measurement(source, settings, readers, [&](std::size_t done, std::size_t total) {
    if (progress.due())
      progress.show(
          fmt::format("measure  {:.0f} %", 100.0 * static_cast<double>(done) / static_cast<double>(total)));
  });
  progress.finish();
  measured.profiles.header = header_of(measured, settings, reduced);
  ScalarSet scalars = measured.scalars;
  const double second = measured.scales.time_s;
  // A run of another program tells nothing of its accuracy.
  const ScalarSet accuracy = run.value("imported", false)
                                 ? ScalarSet{}
                                 : accuracy_scalars(options.run / "log.csv", measured.first_time() * second,
                                                    measured.last_time() * second);
  for (const ScalarSet& more : {friction_scalars(measured, selection), accuracy})
    scalars.scalars.insert(scalars.scalars.end(), more.scalars.begin(), more.scalars.end());
  if (settings.sensitivity) add_friction_variants(measured, selection, measured.variants);

  Json content{{"format", "drumlin-measured-1"}, {"reduced", reduced}};
  for (const Scalar& scalar : scalars.scalars)
    content[scalar.name] = scalar_with_sensitivity(scalar, sensitivity_of(scalar, measured.variants));
  content["steadiness"] = steadiness_of(measured.steadiness);
  content["fits"] = fits_of(measured.fits);
  content["settings"] = settings_of(measured, settings, selection);
  content["provenance"] = {{"measurement", to_json(provenance())}, {"run", run.value("provenance", Json())}};
  for (const char* key : {"revision", "seed"})
    if (run.contains(key)) content["provenance"][std::string("run_") + key] = run[key];

  const auto statement = statement_of(options, run, measured, scalars);
  content["accuracy"] = statement ? to_json(*statement) : Json(nullptr);

  write_profiles(folder / "profiles.csv", measured.profiles);
  write_series(folder / "series.csv", measured.series);
  write_slices(folder, measured, settings, measured.profiles.header, content);
  for (const Part& part : parts) part.write(measured, {folder, content, reduced});
  // The figures read it under another name: measured.json itself says that all is there.
  const fs::path unfinished = folder / "measured.json.part";
  write_json(unfinished, content);
  draw_figures("measure_figures.py", {folder.string(), "--measured", unfinished.string()});
  for (const Part& part : parts)
    if (!part.figures.empty())
      draw_figures(part.figures, {folder.string(), "--measured", unfinished.string()});
  content["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_json(finished, content);
  fs::remove(unfinished);

  fmt::print("{}{}\n", folder.string(), reduced ? " (reduced)" : "");
  if (settings.sensitivity)
    fmt::print("  {:32} {:>12} {:12} {}\n", "", "value", "99 %", "by other windows (measured.json has all)");
  for (const Scalar& scalar : scalars.scalars)
    print_scalar(scalar, sensitivity_of(scalar, measured.variants));
  print_steadiness(measured.steadiness);
  for (const Part& part : parts)
    if (part.print) part.print();
  if (statement) fmt::print("{}", text_of(*statement));
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
