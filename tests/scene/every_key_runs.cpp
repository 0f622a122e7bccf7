#include "tests/scene/every_key_runs.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/json/json_file.hpp"
#include "apps/output/commands.hpp"
#include "coupling/common/errors.hpp"
#include "particles/io/snapshot_file.hpp"
#include "tests/files/folder.hpp"

namespace drumlin::testing {
using namespace particles;

namespace {

std::vector<std::vector<std::string>> fields_of_file(const std::filesystem::path& file) {
  std::vector<std::vector<std::string>> lines;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    lines.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) lines.back().push_back(field);
  }
  return lines;
}

/// Exit code of the run command, as main() would return it; what it says is not shown.
int run_quietly(const apps::RunOptions& options) {
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  int code = 0;
  try {
    code = apps::run(options);
  } catch (const InputError&) {
    code = static_cast<int>(ExitCode::wrong_input);
  } catch (const NotConvergedError&) {
    code = static_cast<int>(ExitCode::not_converged);
  }
  ::testing::internal::GetCapturedStdout();
  ::testing::internal::GetCapturedStderr();
  return code;
}

std::string column(const RunSummary& run, const std::string& name) {
  std::string text;
  std::size_t place = 0;
  while (!run.log.empty() && place < run.log[0].size() && run.log[0][place] != name) ++place;
  for (std::size_t line = 1; line < run.log.size(); ++line) text += run.log[line].at(place) + " ";
  return text;
}

std::string numbers(const std::vector<double>& values, double unit) {
  std::string text;
  for (const double value : values) text += fmt::format("{:.9g} ", value * unit);
  return text;
}

const Snapshot& last(const RunSummary& run) {
  static const Snapshot none;
  return run.snapshots.empty() ? none : run.snapshots.back();
}

}  // namespace

RunSummary summary_of_run(const std::string& scene, const std::vector<std::string>& overrides) {
  const TemporaryFolder folder;
  folder.with("two.csv", "x_mm,z_mm,diameter_mm\n-3,2,3\n3,3,3.5\n");
  folder.with("three.csv", "x_mm,z_mm,diameter_mm,v_x_mm_s\n-3,2,3,50\n3,3,3.5,0\n0,8,3,0\n");
  apps::RunOptions options;
  options.scene = folder.with("scene.toml", scene);
  options.output = folder / "run";
  options.overrides = overrides;
  RunSummary run;
  run.exit_code = run_quietly(options);
  if (!std::filesystem::exists(options.output / "run.json")) return run;
  for (const auto& file : snapshot_files(options.output)) run.snapshots.push_back(read_snapshot(file));
  run.log = fields_of_file(options.output / "log.csv");
  const auto report = read_json(options.output / "run.json", "drumlin-run-1");
  run.status = report.at("status");
  run.title = report.at("title");
  run.reduced = report.at("reduced");
  run.seed = report.at("seed");
  run.steps = report.at("steps");
  run.has_checkpoint = std::filesystem::exists(options.output / "checkpoint.h5");
  std::ifstream energy(options.output / "energy.csv");
  std::getline(energy, run.energy_columns);
  for (const auto& line : fields_of_file(options.output / "walls.csv"))
    for (const auto& field : line) run.wall_lines += field + " ";
  if (std::filesystem::exists(options.output / "problems"))
    for (const auto& file : std::filesystem::directory_iterator(options.output / "problems"))
      run.captured += file.path().extension() == ".h5";
  return run;
}

std::string exit_code(const RunSummary& run) { return std::to_string(run.exit_code); }
std::string title(const RunSummary& run) { return run.title; }
std::string reduced(const RunSummary& run) { return run.reduced ? "reduced" : "full"; }
std::string status(const RunSummary& run) { return run.status; }
std::string steps(const RunSummary& run) { return std::to_string(run.steps); }
std::string checkpoint(const RunSummary& run) { return run.has_checkpoint ? "there" : "none"; }

std::string energy_columns(const RunSummary& run) { return run.energy_columns; }
std::string wall_lines(const RunSummary& run) { return run.wall_lines; }
std::string captured(const RunSummary& run) { return std::to_string(run.captured); }

std::string positions_mm(const RunSummary& run) {
  const double unit = last(run).scales.length_m * 1e3;
  return numbers(last(run).x, unit) + "| " + numbers(last(run).z, unit);
}

std::string spins_rad_s(const RunSummary& run) {
  return numbers(last(run).spin, 1 / last(run).scales.time_s);
}
std::string kinetic_energy(const RunSummary& run) { return column(run, "kinetic_energy"); }
std::string density(const RunSummary& run) { return fmt::format("{:.9g}", last(run).scales.density_kg_m3); }

std::string snapshot_times_s(const RunSummary& run) {
  std::string text;
  for (const auto& snapshot : run.snapshots)
    text += fmt::format("{:.9g} ", snapshot.time * snapshot.scales.time_s);
  return text;
}

std::string windows_s(const RunSummary& run) {
  std::string text;
  for (const auto& snapshot : run.snapshots)
    text += fmt::format("{:.9g}:{} ", snapshot.velocity_window * snapshot.scales.time_s,
                        snapshot.displacement_x.size());
  return text;
}

std::string logged_sweeps(const RunSummary& run) { return column(run, "sweeps"); }
std::string logged_steps(const RunSummary& run) { return column(run, "step"); }
std::string logged_stages(const RunSummary& run) { return column(run, "stage"); }
std::string logged_overlaps(const RunSummary& run) { return column(run, "overlap_mean"); }

}  // namespace drumlin::testing
