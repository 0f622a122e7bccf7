#include "apps/commands/cost/particle_points.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/commands/cost/sweep.hpp"
#include "apps/support/interruption.hpp"
#include "apps/support/progress.hpp"
#include "coupling/common/errors.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/scene/physics.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

particles::SweepStart from_run(const fs::path& folder, const particles::Scene& scene) {
  const particles::RunFolder run = particles::read_run_folder(folder);
  if (!run.finished())
    throw InputError(fmt::format("{}: the run is unfinished (status {}); finish it with drumlin run --resume",
                                 folder.string(), run.status));
  if (particles::scene_text(particles::physics_of(run.scene)) !=
      particles::scene_text(particles::physics_of(scene)))
    throw InputError(folder.string() +
                     ": is a run of another scene: grains, walls, effects and motions have to be the same");
  particles::SweepStart start{run.scene,
                              particles::read_checkpoint(checked_file(run.files, "checkpoint.h5")).state};
  start.scene.solver = scene.solver;
  start.scene.output = scene.output;
  start.scene.stages.push_back(scene.stages.back());
  return start;
}

particles::SimulationState last_stage_reached(const particles::Scene& scene, int threads) {
  Progress progress;
  particles::SimulationState state = particles::at_last_stage(scene, threads, [&](double share) {
    if (progress.due()) progress.show(fmt::format("to the last stage {:.0f} %", 100 * share));
    stop_if_interrupted();
  });
  progress.finish();
  return state;
}

}  // namespace

particles::SweepStart sweep_start(const CostOptions& options, const particles::Scene& scene) {
  const fs::path file = *options.output / "start.h5";
  particles::SweepStart start;
  if (options.from)
    start = from_run(*options.from, scene);
  else
    start.scene = scene;
  start.scene.output.energy_ledger = false;
  for (particles::Stage& stage : start.scene.stages) stage.snapshots = 0;
  if (fs::exists(file)) {
    start.state = particles::read_checkpoint(file).state;
    return start;
  }
  if (!options.from) start.state = last_stage_reached(start.scene, options.threads);
  start.state.energy.reset();
  start.state.marks.clear();
  start.state.snapshots = 0;
  particles::Checkpoint checkpoint;
  checkpoint.scene = particles::scene_text(start.scene);
  checkpoint.state = start.state;
  particles::write_checkpoint(file, checkpoint);
  return start;
}

}  // namespace drumlin::apps
