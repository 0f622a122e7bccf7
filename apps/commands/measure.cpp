// drumlin measure: profiles and scalars of a finished particle run.
#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "apps/support/progress.hpp"
#include "coupling/calibration/log_friction.hpp"
#include "coupling/exchange/errors.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/measurement/intervals.hpp"
#include "particles/measurement/measurement.hpp"
#include "particles/measurement/run_log.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double quantile_99 = 2.576;  // half width of a 99 % interval per standard error

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

/// mu_a and mu_b at the centre: the fit of `drumlin calibrate` on this run alone. Layers of one run move
/// together (a steeper surface raises mu in all), which the fit cannot know: the spread over time is added to
/// its own errors.
ScalarSet friction_scalars(const Measurement& measured, const LayerSelection& selection) {
  const double nan = std::nan("");
  const auto law_of = [&](const ProfileSet& profiles) {
    const auto points = friction_points(profiles, selection);
    return points.size() < 3 ? LogFriction{nan, nan, {nan, nan, nan}, nan, nan}
                             : fit_log_friction(points).law;
  };
  const LogFriction law = law_of(measured.profiles);
  std::vector<double> a, b;
  for (ProfileSet without : measured.leave_one_out) {
    // They lack the header and the intervals, so that their layers would be chosen and weighted otherwise.
    without.header = measured.profiles.header;
    for (ProfileColumn& column : without.columns) {
      column.ci99 = measured.profiles.column(column.name).ci99;
      column.ci99.resize(without.z.size());
    }
    const LogFriction one = law_of(without);
    a.push_back(one.a);
    b.push_back(one.b);
  }
  return {{{"mu_a", law.a, std::hypot(jackknife_ci99(a), quantile_99 * std::sqrt(law.covariance[0]))},
           {"mu_b", law.b, std::hypot(jackknife_ci99(b), quantile_99 * std::sqrt(law.covariance[2]))}}};
}

std::map<std::string, std::string> header_of(const Measurement& m, const MeasurementOptions& options,
                                             bool reduced) {
  const auto text = [](double value) { return fmt::format("{}", value); };
  return {{"side", "particles"},
          {"reduced", reduced ? "true" : "false"},
          {"theta_deg", text(m.frame_angle_deg)},
          {"axis_depth", text(m.axis_depth)},
          {"wall_z", text(m.wall_z)},
          {"rotation", text(m.rotation)},
          {"drum_radius", text(m.container_radius)},
          {"diameter_m", text(m.scales.length_m)},
          {"position", text(options.position)},
          {"slice_width", text(m.slice_width)},
          {"layer_thickness", text(options.layer_thickness)},
          {"snapshots", std::to_string(m.snapshots)},
          {"batches", std::to_string(m.batches)},
          {"interval_factor", text(m.batches > 1 ? interval_factor(m.batches) : std::nan(""))},
          {"revision", provenance().revision}};
}

Json settings_of(const Measurement& m, const MeasurementOptions& options, const LayerSelection& selection) {
  return {
      {"frame", "turns with the drum; x downslope, z along the normal of the surface"},
      {"frame_from", name_of(m.frame_source)},
      {"frame_angle_deg", m.frame_angle_deg},
      {"seen_in_a_mirror", m.in_mirror},
      {"slope_isoline_nu", options.slope_isoline},
      {"slope_half_width", m.slope_half_width},
      {"slope_half_width_asked", options.slope_half_width},
      {"surface_nu", options.surface_nu},
      {"position", options.position},
      {"slice_width", m.slice_width},
      {"slice_width_asked", options.slice_width},
      {"layer_thickness", options.layer_thickness},
      {"velocity_window", m.velocity_window},
      {"surface_speed_depth", options.scalars.surface_speed_depth},
      {"linear_share", options.scalars.linear_share},
      {"decay_window_below_H", {options.scalars.decay_to, options.scalars.decay_from}},
      {"bulk_margin", options.bulk_margin},
      {"mu_fit_I", {selection.I_min, selection.I_max}},
      {"mu_fit_surface_margin", selection.surface_margin},
      {"mu_fit_wall_margin", selection.wall_margin},
      {"intervals", "99 %, delete-one jackknife over contiguous batches, neighbours' correlation, Student t"},
      {"batches", m.batches},
      {"snapshots", m.snapshots},
      {"first_snapshot", m.first_snapshot},
      {"first_time", m.first_time},
      {"last_time", m.last_time},
      {"rotation", m.rotation},
      {"axis_depth", m.axis_depth},
      {"wall_z", m.wall_z},
      {"drum_radius", m.container_radius},
      {"scales", to_json(m.scales)}};
}

/// What the figures draw over the profiles.
Json fits_of(const ProfileScalars& fits) {
  return {{"surface_speed", fits.surface_speed},
          {"fit_bottom", fits.fit_bottom},
          {"fit_top", fits.fit_top},
          {"decay_log_rate", fits.decay_log_rate}};
}

void print_summary(const fs::path& folder, const ScalarSet& scalars, bool reduced) {
  fmt::print("{}{}\n", folder.string(), reduced ? " (reduced)" : "");
  for (const Scalar& scalar : scalars.scalars) {
    const std::string value =
        std::isfinite(scalar.value) ? fmt::format("{:.4g}", scalar.value) : "not measured";
    const bool known = scalar.ci99 && std::isfinite(*scalar.ci99);
    fmt::print("  {:26} {}{}\n", scalar.name, value, known ? fmt::format(" +- {:.2g}", *scalar.ci99) : "");
  }
}

}  // namespace

int measure(const MeasureOptions& options) {
  const auto start = std::chrono::steady_clock::now();
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

  MeasurementOptions settings;
  settings.position = options.position;
  settings.slice_width = options.slice_width;
  settings.layer_thickness = options.layer_thickness;
  const LayerSelection selection;
  const SnapshotSource source{files.size(), [&](std::size_t i) { return read_snapshot(files[i]); }};
  Progress progress;
  Measurement measured = measurement(source, settings, [&](std::size_t done, std::size_t total) {
    if (progress.due())
      progress.show(
          fmt::format("measure  {:.0f} %", 100.0 * static_cast<double>(done) / static_cast<double>(total)));
  });
  progress.finish();
  measured.profiles.header = header_of(measured, settings, reduced);
  ScalarSet scalars = measured.scalars;
  const double second = measured.scales.time_s;
  for (const ScalarSet& more :
       {friction_scalars(measured, selection),
        accuracy_scalars(options.run / "log.csv", measured.first_time * second, measured.last_time * second)})
    scalars.scalars.insert(scalars.scalars.end(), more.scalars.begin(), more.scalars.end());

  Json content{{"format", "drumlin-measured-1"}, {"reduced", reduced}};
  add_scalars(content, scalars);
  content["fits"] = fits_of(measured.fits);
  content["settings"] = settings_of(measured, settings, selection);
  content["provenance"] = {{"measurement", to_json(provenance())}, {"run", run.value("provenance", Json())}};
  for (const char* key : {"revision", "seed"})
    if (run.contains(key)) content["provenance"][std::string("run_") + key] = run[key];

  write_profiles(folder / "profiles.csv", measured.profiles);
  // The figures read it under another name: measured.json itself says that all is there.
  const fs::path unfinished = folder / "measured.json.part";
  write_json(unfinished, content);
  draw_figures("measure_figures.py", {folder.string(), "--measured", unfinished.string()});
  content["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  write_json(finished, content);
  fs::remove(unfinished);
  print_summary(folder, scalars, reduced);
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
