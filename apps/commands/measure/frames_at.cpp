#include "apps/commands/measure/frames_at.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/output/results.hpp"
#include "apps/process/request_sum.hpp"
#include "apps/process/progress.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/basics/provenance.hpp"
#include "coupling/core/documents/csv.hpp"
#include "coupling/core/hdf5/frames_file.hpp"
#include "coupling/core/results/measured_run.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/measurement/frames/run_frames.hpp"
#include "particles/scene/scene_walls.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Range = std::optional<std::array<double, 2>>;

[[noreturn]] void refuse_option(const char* option, const std::string& value, const char* allowed) {
  throw InputError({InputProblem{"", 0, 0, option, "is " + value, allowed}});
}

/// Seconds of a list of numbers and of from:to:step.
std::vector<double> times_of(const std::vector<std::string>& list) {
  constexpr std::size_t most = 100000;
  constexpr const char* allowed =
      "ascending times in s, at most 100000: numbers, or from:to:step with a step above 0";
  std::vector<double> times;
  for (const std::string& entry : list) {
    std::vector<double> numbers;
    std::istringstream stream(entry);
    for (std::string word; std::getline(stream, word, ':');) {
      const auto number = finite_number(word);
      if (!number) refuse_option("--at", entry, allowed);
      numbers.push_back(*number);
    }
    if (numbers.size() == 1) numbers = {numbers[0], numbers[0], 1};
    if (numbers.size() != 3 || !(numbers[2] > 0)) refuse_option("--at", entry, allowed);
    constexpr double rounding = 1e-9;  // of a step
    const double steps = std::floor((numbers[1] - numbers[0]) / numbers[2] + rounding);
    if (!(steps >= 0 && steps < static_cast<double>(most))) refuse_option("--at", entry, allowed);
    for (double step = 0; step <= steps; ++step) {
      times.push_back(numbers[0] + step * numbers[2]);
      if (times.size() > most || (times.size() > 1 && !(times[times.size() - 2] < times.back())))
        refuse_option("--at", entry, allowed);
    }
  }
  return times;
}

Range range_of(const char* option, const std::vector<double>& ends) {
  if (ends.empty()) return std::nullopt;
  if (ends.size() != 2 || !(ends[0] < ends[1]) || !std::isfinite(ends[0]) || !std::isfinite(ends[1]))
    refuse_option(option, fmt::format("{}", fmt::join(ends, ",")), "two numbers in d, the smaller one first");
  return std::array{ends[0], ends[1]};
}

void check_scene(const particles::RunFolder& run, const particles::RunFolder& first) {
  const std::string name = run.folder.string();
  if (run.scene.periodic_x)
    throw InputError(name + ": a periodic domain, which has no frames (allowed: scenes without periodic_x)");
  if (run.scales.length_m != first.scales.length_m || run.scales.time_s != first.scales.time_s ||
      run.scales.density_kg_m3 != first.scales.density_kg_m3)
    throw InputError(
        fmt::format("{}: other units than in {}: an ensemble is of one scene", name, first.folder.string()));
}

/// `run` lives as long as this.
particles::FrameRun frame_run(const particles::RunFolder& run) {
  const particles::Walls walls = particles::walls_of(run.scene, run.scales);
  particles::FrameRun result{.name = run.folder.string(),
                             .times = {},
                             .read = {},
                             .walls = walls.names,
                             .wall_of_shape = walls.wall_of_shape,
                             .shapes_at = {}};
  for (const fs::path& file : run.snapshots) result.times.push_back(particles::snapshot_time(file));
  result.read = [&run](std::size_t i) { return particles::checked_snapshot(run, run.snapshots[i]); };
  result.shapes_at = [&run](const particles::Snapshot& snapshot) {
    std::vector<particles::Shape> shapes;
    for (const particles::PlacedShape& placed : particles::shapes_at(run, snapshot))
      shapes.push_back(placed.shape);
    return shapes;
  };
  return result;
}

}  // namespace

int measure_frames(const MeasureOptions& options) {
  particles::FrameOptions settings{.times = times_of(options.at),
                                   .spacing = options.map_spacing,
                                   .width = options.map_width,
                                   .x = range_of("--x", options.x),
                                   .z = range_of("--z", options.z),
                                   .nu_bulk = options.nu_bulk};
  (void)grid_over(0, 1, 0, 1, settings.spacing, settings.width);
  nlohmann::ordered_json sums = nlohmann::ordered_json::array();
  for (const fs::path& run : options.runs) sums.push_back(input_sum(run));
  const ResultsRequest asked = results_of(options, "measure", *options.output, "frames.h5", sums);
  return make_results(asked, [&](Results& results) -> Made {
    std::vector<particles::RunFolder> folders;
    for (const fs::path& run : options.runs) {
      folders.push_back(particles::read_run_folder(run));
      check_scene(folders.back(), folders.front());
    }
    std::vector<particles::FrameRun> runs;
    for (const particles::RunFolder& run : folders) runs.push_back(frame_run(run));
    const Scales& scales = folders.front().scales;
    settings.origin = options.origin.value_or(0) / scales.time_s;
    for (double& time : settings.times) time /= scales.time_s;
    const fs::path& folder = results.begin();
    Progress progress;
    auto frames = particles::frames_of(runs, settings, [&](std::size_t done, std::size_t total) {
      if (progress.due())
        progress.show(
            fmt::format("measure  {:.0f} %", 100.0 * static_cast<double>(done) / static_cast<double>(total)));
    });
    for (std::string& run : frames.runs) run = name_of_folder(run);
    progress.finish();
    frames.header.title = folders.front().scene.title;
    frames.header.reduced = folders.front().scene.reduced;
    frames.header.revision = provenance().revision;
    write_frames(folder / "frames.h5", frames);
    return {fmt::format("{}{}: {} runs at {} times, {} x {} nodes, nu_bulk {:.4f}\n", asked.folder.string(),
                        folders.front().scene.reduced ? " (reduced)" : "", runs.size(), frames.times.size(),
                        frames.grid.columns, frames.grid.rows, frames.nu_bulk)};
  });
}

}  // namespace drumlin::apps
