#include "apps/commands/cost/particle_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands/accuracy_statement.hpp"
#include "apps/commands/cost/sweep.hpp"
#include "apps/commands/run_folder.hpp"
#include "apps/support/progress.hpp"
#include "coupling/exchange/errors.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t parts_of_stretch = 4;  // steps are a multiple of it, so that all marks lie on steps

SweepStart from_run(const fs::path& folder, const Scene& scene) {
  nlohmann::ordered_json json;
  const RunFolder run = read_run_folder(folder, json);
  if (!run.finished())
    throw InputError(fmt::format("{}: the run is unfinished (status {}); finish it with drumlin run --resume",
                                 folder.string(), run.status));
  if (scene_text(physics_of(run.scene)) != scene_text(physics_of(scene)))
    throw InputError(folder.string() +
                     ": is a run of another scene: grains, walls, effects and motions have to be the same");
  SweepStart start{run.scene, read_checkpoint(folder / "checkpoint.h5").state};
  start.scene.solver = scene.solver;
  start.scene.output = scene.output;
  start.scene.stages.push_back(scene.stages.back());
  return start;
}

SimulationState at_last_stage(const Scene& scene, int threads) {
  Simulation simulation(scene, threads);
  const auto& plan = simulation.plan();
  const std::int64_t steps = plan.steps - plan.stages.back().steps;
  Progress progress;
  while (simulation.state().step < steps) {
    const StepReport report = simulation.step();
    if (report.lost) throw NotConvergedError("a grain is lost on the way to the last stage");
    if (progress.due())
      progress.show(
          fmt::format("to the last stage {:.0f} %",
                      100.0 * static_cast<double>(simulation.state().step) / static_cast<double>(steps)));
    stop_if_interrupted();
  }
  progress.finish();
  return simulation.state();
}

}  // namespace

std::string name_of(const ParticleSettings& s) {
  return fmt::format("{}-tolerance-{:g}-step-{:g}", s.solver, s.tolerance, s.step_s);
}

SweepStart sweep_start(const CostOptions& options, const Scene& scene) {
  const fs::path file = *options.output / "start.h5";
  SweepStart start;
  if (options.from)
    start = from_run(*options.from, scene);
  else
    start.scene = scene;
  start.scene.output.energy_ledger = false;
  for (Stage& stage : start.scene.stages) stage.snapshots = 0;
  if (fs::exists(file)) {
    start.state = read_checkpoint(file).state;
    return start;
  }
  if (!options.from) start.state = at_last_stage(start.scene, options.threads);
  start.state.energy.reset();
  start.state.marks.clear();
  start.state.snapshots = 0;
  Checkpoint checkpoint;
  checkpoint.scene = scene_text(start.scene);
  checkpoint.state = start.state;
  write_checkpoint(file, checkpoint);
  return start;
}

Scene with_settings(const Scene& scene, const ParticleSettings& settings, double seconds) {
  Scene changed = scene;
  Stage& stage = changed.stages.back();
  stage.turns.reset();
  stage.duration_s = seconds;
  const double parts = static_cast<double>(parts_of_stretch);
  stage.time_step_s = seconds / (parts * std::ceil(seconds / (parts * settings.step_s) - 1e-9));
  SolverSettings& solver = changed.solver;
  const double harder = std::clamp(solver.tolerance / settings.tolerance, 1.0, 1e4);
  solver.max_sweeps = static_cast<int>(std::min(1e6, std::ceil(solver.max_sweeps * harder)));
  solver.name = settings.solver;
  solver.tolerance = settings.tolerance;
  solver.stop_when_unconverged = false;
  solver.capture_unconverged = 0;
  return changed;
}

std::vector<Mark> marks_along(const SweepStart& start, const ParticleSettings& settings, double seconds,
                              int threads) {
  Simulation simulation(with_settings(start.scene, settings, seconds), start.state, threads);
  const std::int64_t steps = simulation.plan().stages.back().steps;
  std::vector<Mark> marks;
  Mark now;
  double overlap = 0;
  const double begun = process_seconds();
  for (std::int64_t step = 1; step <= steps; ++step) {
    const StepReport report = simulation.step();
    if (report.lost) throw NotConvergedError(fmt::format("{}: a grain is lost", name_of(settings)));
    stop_if_interrupted();
    now.steps = step;
    now.sweeps += report.solve.sweeps;
    now.contact_sweeps += static_cast<double>(report.contacts) * report.solve.sweeps;
    now.missed += report.contacts > 0 && report.solve.status != Status::converged;
    overlap += report.overlap.mean;
    const std::int64_t quarters = parts_of_stretch * step;
    if (quarters != steps && quarters != 2 * steps && quarters != 4 * steps) continue;
    now.cpu_seconds = process_seconds() - begun;
    now.overlap_d = overlap / static_cast<double>(step);
    now.bodies = simulation.state().bodies;
    marks.push_back(now);
  }
  return marks;
}

}  // namespace drumlin::apps
