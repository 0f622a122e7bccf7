// drumlin measure: profiles and scalars of a finished particle run.
#include "apps/commands/measure/measure.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/commands/accuracy_statement.hpp"
#include "apps/commands/measure/content.hpp"
#include "apps/commands/measure/frames_at.hpp"
#include "apps/commands/measure/part.hpp"
#include "apps/commands/measure/space_part.hpp"
#include "apps/commands/measure/summary.hpp"
#include "apps/commands/run_accuracy.hpp"
#include "apps/commands/run_report.hpp"
#include "apps/commands/study.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/next_step.hpp"
#include "apps/output/pending_figures.hpp"
#include "apps/output/results.hpp"
#include "apps/process/progress.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/run_status.hpp"
#include "coupling/core/documents/csv.hpp"
#include "coupling/core/files/result_folder.hpp"
#include "coupling/core/files/text_file.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/layers/scalars.hpp"
#include "particles/measurement/measurement.hpp"
#include "particles/measurement/measurement_header.hpp"
#include "particles/measurement/run_log.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin {
/// What the figures draw over the profiles.
DRUMLIN_DESCRIBED(ProfileScalars, surface_speed, fit_bottom, fit_top, decay_log_rate)
}  // namespace drumlin

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double narrow_slice_width = 2;    // d, as the paper's five slices
constexpr double surface_nu_spheres = 0.3;  // half of a packing: flows of spheres reach 0.5 to 0.6

ResultFolder run_in(const fs::path& run) {
  if (!fs::is_directory(run)) throw InputError(run.string() + ": no such folder");
  if (!fs::exists(run / "run.json"))
    throw InputError(run.string() + ": holds no run.json, so no particle run");
  return open_result_folder(run);
}

RunRecord finished_run(const ResultFolder& folder) {
  const fs::path& run = folder.path;
  RunRecord record = read_record<RunRecord>(run / "run.json");
  if (record.status != name_of(RunStatus::finished) || !folder.manifest->complete)
    throw InputError(
        fmt::format("{}: the run is unfinished (status {}); continue it with drumlin run --resume",
                    run.string(), record.status));
  return record;
}

particles::MeasurementOptions settings_for(const MeasureOptions& options) {
  particles::MeasurementOptions settings;
  settings.scratch_folder = options.run();
  settings.since_s = options.since;
  settings.position = options.position;
  settings.slice_width = options.slice_width;
  settings.layer_thickness = options.layer_thickness;
  if (names_part(options, "gradients")) settings.gradient_step = options.gradient_step;
  if (names_part(options, "slices"))
    settings.slices = particles::SlicesRequest{options.slices, narrow_slice_width};
  settings.sensitivity = names_part(options, "sensitivity");
  settings.voronoi = names_part(options, "voronoi");
  return settings;
}

std::string slice_name(double position) { return fmt::format("slices/x{:+.1f}.csv", position); }

void check_slices(const std::vector<double>& positions) {
  constexpr double farthest = 1e6;  // d
  std::map<std::string, double> names;
  for (const double position : positions) {
    if (!(std::abs(position) <= farthest))
      throw InputError({InputProblem{"", 0, 0, "--slices", fmt::format("is {:g}", position),
                                     fmt::format("numbers in d, -{0:g} to {0:g}", farthest)}});
    if (const auto [other, is_new] = names.emplace(slice_name(position), position); !is_new)
      throw InputError({InputProblem{"", 0, 0, "--slices",
                                     fmt::format("has {:g} and {:g} in one place", other->second, position),
                                     "places at least 0.1 d apart"}});
  }
}

/// slices/NAME.csv for each slice, and what was read off it.
void write_slices(const fs::path& folder, const particles::Measurement& measured,
                  const particles::MeasurementOptions& settings, const RunHeader& header, Json& content) {
  if (measured.slices.empty()) return;
  make_folders(folder / "slices");
  Json list = Json::array();
  for (const particles::MeasuredSlice& slice : measured.slices) {
    ProfileSet profiles = slice.profiles;
    profiles.header = particles::slice_header(header, slice);
    const std::string file = slice_name(slice.position);
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
void write_series(const fs::path& file, const particles::TimeSeries& series) {
  std::string text = "# drumlin-series-1\ntime,turns,kinetic_energy,theta_com_deg";
  const bool packing = !series.pressure.empty();
  text += packing ? ",pressure,shear_stress,shear_rate\n" : "\n";
  for (std::size_t s = 0; s < series.time.size(); ++s) {
    std::vector<std::string> fields{
        csv_number(series.time[s]), csv_number(series.wall_angle[s] / (2 * std::numbers::pi)),
        csv_number(series.kinetic_energy[s]),
        series.mass_angle.empty() ? "" : csv_number(series.mass_angle[s] * 180 / std::numbers::pi)};
    if (packing)
      for (const auto* values : {&series.pressure, &series.shear_stress, &series.shear_rate})
        fields.push_back(csv_number((*values)[s]));
    text += csv_line(fields);
  }
  replace_file(file, text);
}

/// Each snapshot stands for a stretch: what their first and last times leave out.
double both_ends(const particles::Measurement& measured) {
  const double snapshots = static_cast<double>(measured.series.time.size());
  return snapshots > 1 ? snapshots / (snapshots - 1) : 1;
}

double sampled_seconds(const particles::Measurement& measured) {
  return both_ends(measured) * (measured.last_time() - measured.first_time()) * measured.scales.time_s;
}

/// What is known beside the intervals; nothing of another program's run.
Json statement_of(const MeasureOptions& options, const RunRecord& run, const particles::Measurement& measured,
                  const ScalarSet& scalars) {
  if (run.imported.value_or(false) || !fs::exists(options.run() / "scene.toml")) return {};
  const particles::Scene scene = particles::read_scene(options.run() / "scene.toml");
  const double turned = measured.series.wall_angle.empty()
                            ? 0
                            : measured.series.wall_angle.back() - measured.series.wall_angle.front();
  const RunCost cost{.cpu_seconds = run.cpu_seconds.value_or(0),
                     .simulated_seconds = run.simulated_seconds.value_or(0),
                     .sampled_seconds = sampled_seconds(measured),
                     .turns = both_ends(measured) * std::abs(turned) / (2 * std::numbers::pi)};
  ScalarSet with_intervals;
  for (const Scalar& scalar : scalars.scalars)
    if (scalar.ci99 && std::isfinite(scalar.value)) with_intervals.scalars.push_back(scalar);
  return accuracy_statement(scene, accuracy_record(options.accuracy, scene), with_intervals, cost);
}

/// Steps that missed a tolerance, where they are more than leave no trace in averages.
void note_missed_steps(const RunRecord& run, particles::Steadiness& steadiness) {
  const auto missed = static_cast<double>(run.unconverged_steps.value_or(0)),
             steps = static_cast<double>(run.steps.value_or(0));
  if (!(missed > unseen_missed_share * steps)) return;
  steadiness.steady = false;
  steadiness.reasons.push_back(
      fmt::format("{:.0f} of {:.0f} steps ({:.0f} %) of the whole run missed a tolerance: their forces and "
                  "positions do not hold",
                  missed, steps, 100 * missed / steps));
}

/// A run with what was asked of it.
struct Request {
  const MeasureOptions& options;
  particles::MeasurementOptions settings;
  coupling::LayerSelection selection;  ///< of the fit of mu(I)
  RunRecord run;
  bool reduced = false;
  std::vector<Part> parts;
  std::optional<particles::SphereView> spheres = {};  ///< nothing: discs
};

particles::Measurement measured_run(const Request& request, const std::vector<fs::path>& files) {
  std::vector<particles::MeasurementPart> readers;
  for (const Part& part : request.parts) readers.push_back(part.reading);
  const particles::SnapshotSource source{files.size(), [&](std::size_t i) {
                                           return request.spheres
                                                      ? particles::read_spheres(files[i], *request.spheres)
                                                      : particles::read_snapshot(files[i]);
                                         }};
  Progress progress;
  particles::Measurement measured =
      particles::measurement(source, request.settings, readers, [&](std::size_t done, std::size_t total) {
        if (progress.due())
          progress.show(fmt::format("measure  {:.0f} %",
                                    100.0 * static_cast<double>(done) / static_cast<double>(total)));
      });
  progress.finish();
  measured.profiles.header = particles::measurement_header(measured, request.settings, request.reduced);
  return measured;
}

/// mu(I) at the centre, as mu_a and mu_b (docs/theory/measurement.md).
coupling::CentreFriction friction_of(const Request& request, const particles::Measurement& measured) {
  const std::size_t parts = measured.leave_one_out.size();
  return coupling::centre_friction(measured.profiles, measured.leave_one_out,
                                   parts < 2 ? std::nan("") : particles::interval_factor(parts),
                                   request.selection);
}

/// The curve that figures draw: null where there is no law.
Json curve_of(const LogLaw& law) {
  if (!std::isfinite(law.a) || !(law.I_min < law.I_max)) return {};
  return law_curve(law, law.I_min, law.I_max);
}

/// Those of the measurement, of the fit of mu(I) and of the log.
ScalarSet all_scalars(const Request& request, const particles::Measurement& measured,
                      const ScalarSet& friction) {
  ScalarSet scalars = measured.scalars;
  const double second = measured.scales.time_s;
  // A run of another program tells nothing of its accuracy.
  const ScalarSet accuracy =
      request.run.imported.value_or(false)
          ? ScalarSet{}
          : particles::accuracy_scalars(request.options.run() / "log.csv", measured.first_time() * second,
                                        measured.last_time() * second);
  for (const ScalarSet& more : {friction, accuracy})
    scalars.scalars.insert(scalars.scalars.end(), more.scalars.begin(), more.scalars.end());
  return scalars;
}

/// measured.json but for what the parts and the slices add.
Json content_of(const Request& request, const particles::Measurement& measured, const ScalarSet& scalars,
                const Json& statement) {
  const RunRecord& run = request.run;
  Json content{{"format", MeasuredRecord::format}, {"reduced", request.reduced}};
  for (const Scalar& scalar : scalars.scalars)
    content[scalar.name] =
        scalar_with_sensitivity(scalar, particles::sensitivity_of(scalar, measured.variants));
  content["steadiness"] = steadiness_of(measured.steadiness);
  content["fits"] = measured.fits;
  content["settings"] = settings_of(measured, request.settings, request.selection);
  content["provenance"] = {{"measurement", provenance()}, {"run", run.provenance.json}};
  if (run.revision) content["provenance"]["run_revision"] = *run.revision;
  if (run.seed) content["provenance"]["run_seed"] = *run.seed;
  content["accuracy"] = statement;
  return content;
}

/// What the run told of itself stands in the place of a statement that knows no errors.
void print_accuracy(const Request& request, const Json& statement, const ScalarSet& scalars) {
  const Json& accuracy = request.run.accuracy.json;
  const Json stretches = accuracy.is_null() ? Json() : accuracy.value("stretches", Json());
  if (!stretches.is_null() && (statement.is_null() || statement.at("record").is_null()))
    print_out(text_of_stretches(stretches, request.run.cpu_seconds.value_or(0)));
  else if (!statement.is_null())
    print_out(text_of(statement, scalars));
}

void print_results(const Request& request, const fs::path& folder, const particles::Measurement& measured,
                   const ScalarSet& scalars, bool verbose) {
  print_out(fmt::format("{}{}\n", folder.string(), request.reduced ? " (reduced)" : ""));
  print_summary(measured, scalars, request.settings.sensitivity, verbose);
  for (const Part& part : request.parts)
    if (part.print && verbose) part.print();
}

/// Of the files that are there now.
std::vector<FigureScript> figures_of(const Request& request, const fs::path& folder) {
  if (request.options.no_figures) return {};
  const std::vector<std::string> words{folder.string()};
  std::vector<FigureScript> figures{{"measure_figures.py", words}};
  for (const Part& part : request.parts)
    if (!part.figures.empty()) figures.push_back({part.figures, words});
  return figures;
}

Flowing flowing_of(const particles::MeasurementFrame& place) {
  return place.container_radius > 0 ? Flowing::drum : place.period > 0 ? Flowing::layers : Flowing::open;
}

Verdict verdict_of(const particles::Measurement& measured, const LogLaw& law) {
  if (!measured.steadiness.flows) return Verdict::rests;
  if (!measured.steadiness.steady) return Verdict::unsteady;
  constexpr double least_range = 3;  // of I: less leaves b of a + b ln I to chance
  return law.I_max >= least_range * law.I_min ? Verdict::done : Verdict::one_rate;
}

/// The run with what was asked of it; refused where it is one of discs and spheres were asked for.
Request request_for(const MeasureOptions& options, const RunRecord& run, bool spheres) {
  if (!spheres && (!options.slab.empty() || options.along != MeasureOptions{}.along))
    throw InputError("--along, --slab: the run is one of discs (allowed: imported spheres)");
  Request request{options, settings_for(options),       {},
                  run,     run.reduced.value_or(false), reading_parts(options)};
  if (!spheres) return request;
  request.settings.surface_nu = surface_nu_spheres;
  request.spheres = sphere_view(options);
  request.parts.push_back(space_part(options));
  return request;
}

int measure_run(const MeasureOptions& asked) {
  const auto start = std::chrono::steady_clock::now();
  check_parts(asked.parts);
  check_slices(asked.slices);
  ResultsRequest requested = results_of(asked, "measure", asked.run() / "measured", "measured.json");
  requested.computed_from = asked.run();
  if (is_done_already(requested)) return static_cast<int>(ExitCode::done);
  (void)run_in(asked.run());  // a lock is left in no folder of somebody else
  const FolderLock run_lock(asked.run() / folder_lock_name, "drumlin measure");
  const ResultFolder run_folder = run_in(asked.run());
  check_all_files(run_folder);
  const auto files = particles::snapshot_files(asked.run());
  const RunRecord record = finished_run(run_folder);
  if (files.empty())
    throw InputError(asked.run().string() + ": holds no snapshots: there is nothing to measure");
  const bool spheres = particles::holds_spheres(files.front());
  const MeasureOptions options = spheres ? options_for_spheres(asked) : asked;
  const Request request = request_for(options, record, spheres);
  Results results(requested);
  const fs::path& folder = results.begin();

  particles::Measurement measured = measured_run(request, files);
  note_missed_steps(request.run, measured.steadiness);
  const coupling::CentreFriction friction = friction_of(request, measured);
  const ScalarSet scalars = all_scalars(request, measured, friction.scalars);
  if (request.settings.sensitivity) add_friction_variants(measured, request.selection, measured.variants);
  const auto statement = statement_of(options, request.run, measured, scalars);
  Json content = content_of(request, measured, scalars, statement);
  content["friction_curve"] = curve_of(friction.law);
  add_accepted_edits(content["provenance"], accepted_edits(run_folder));

  write_profiles(folder / "profiles.csv", measured.profiles);
  write_series(folder / "series.csv", measured.series);
  write_slices(folder, measured, request.settings, measured.profiles.header, content);
  for (const Part& part : request.parts) part.write(measured, {folder, content, request.reduced});
  content["seconds"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  // Figures come after all numbers: one that cannot be drawn must not cost them.
  note_pending_figures(folder);
  write_json(folder / "measured.json", content);
  const std::vector<std::string> failures = draw_pending_figures(folder, figures_of(request, folder));
  results.publish();

  print_results(request, requested.folder, measured, scalars, options.verbose);
  print_accuracy(request, statement, scalars);
  print_out(next_step(record.imported.value_or(false) ? "measure imported" : "measure",
                      flowing_of(measured.place), verdict_of(measured, friction.law), options.run().string(),
                      sampled_seconds(measured)));
  throw_if_figures_failed(requested.folder / requested.finished, failures);
  return static_cast<int>(ExitCode::done);
}

}  // namespace

int measure(const MeasureOptions& options) {
  if (options.study.empty() == options.runs.empty())
    throw InputError("measure: one of RUN and --study RUN... is required");
  if (!options.at.empty()) return measure_frames(options);
  if (options.runs.size() > 1) throw InputError("measure: several runs need --at TIMES");
  if (options.study.empty() == options.output.has_value())
    throw InputError("measure: --study RUN... together with --output STUDY is required");
  return options.study.empty()
             ? measure_run(options)
             : study(results_of(options, "study", *options.output, "study.json"), options.study);
}

Command measure_command() {
  return command("measure", "Profiles and scalars of a run, into RUN/measured; or its fields at given times",
                 measure);
}

}  // namespace drumlin::apps
