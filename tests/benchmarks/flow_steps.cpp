#include "tests/benchmarks/flow_steps.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <optional>

#include "coupling/core/basics/errors.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/lab/any_solver.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::benchmark {
using namespace particles;

namespace {

constexpr int most_that_flow =
    10000;  // larger drums are packed and begin to turn: as good for sweeps and threads
constexpr double replayed_s = 0.2;  // of the last stage, to be replayed

Scene drum_of(Scene scene, int discs) {
  auto* generated = std::get_if<GeneratedGrains>(&scene.grains.source);
  auto* container = scene.walls.size() == 1 ? std::get_if<ContainerShape>(&scene.walls[0].shape) : nullptr;
  auto* region = generated != nullptr ? std::get_if<CircleRegion>(&generated->region) : nullptr;
  if (container == nullptr || region == nullptr || scene.stages.back().motions.empty())
    throw InputError("the scene is no drum of generated grains that turns");
  const double larger = std::sqrt(static_cast<double>(discs) / generated->count);
  generated->count = discs;
  container->radius_mm *= larger, region->radius_mm *= larger;
  Stage settle = scene.stages.front(), flow = scene.stages.back();
  auto& rotation = std::get<Rotation>(flow.motions[0].motion);
  rotation.speed_rpm /= std::sqrt(larger);
  settle.snapshots = flow.snapshots = 0;
  settle.turns = flow.turns = std::nullopt;
  const bool flows = discs <= most_that_flow;
  settle.duration_s = flows ? 0.6 : 0.3;
  flow.duration_s = (flows ? 1.0 : 0.1) + replayed_s;
  scene.stages = {settle, flow};
  scene.solver = SolverSettings{};
  return scene;
}

/// The state from which the flow is kept, from the cache or computed for it.
SimulationState flowing_state(const Scene& scene, const std::filesystem::path& cache) {
  const int discs = std::get<GeneratedGrains>(scene.grains.source).count;
  const auto file = cache / fmt::format("flow-{}.h5", discs);
  const std::string text = scene_text(scene);
  if (std::filesystem::exists(file)) {
    Checkpoint known = read_checkpoint(file);
    if (known.scene == text) return std::move(known.state);
  }
  Simulation simulation(scene, 2);
  const double end =
      (duration_s(scene.stages[0]) + duration_s(scene.stages[1]) - replayed_s) / simulation.scales().time_s;
  while (simulation.state().time() < end) (void)simulation.step();
  Checkpoint checkpoint;
  checkpoint.scene = text;
  checkpoint.state = simulation.state();
  std::filesystem::create_directories(cache);
  write_checkpoint(file, checkpoint);
  return checkpoint.state;
}

}  // namespace

Flow flow_of(const Scene& like, int discs, int steps, const std::filesystem::path& cache) {
  const Scene scene = drum_of(like, discs);
  Simulation simulation(scene, flowing_state(scene, cache));
  Flow flow;
  flow.discs = discs;
  flow.laws = laws_of(scene, simulation.scales());
  Walls walls = walls_of(scene, simulation.scales());
  begin_stage(walls, scene.stages[simulation.state().stage], simulation.scales(), 0);
  walls.pose_at_start = simulation.state().pose_at_start;
  flow.time_step = simulation.plan().stages[simulation.state().stage].time_step;
  for (int k = 0; k < steps && !simulation.finished(); ++k) {
    const SimulationState& now = simulation.state();
    flow.steps.push_back({now.bodies, now.memory, wall_step(walls, now.time_in_stage, flow.time_step)});
    (void)simulation.step();
  }
  return flow;
}

Replay::Replay(const Flow& flow, const std::string& solver, int threads, const StoppingRule& rule)
    : laws_(flow.laws),
      time_step_(flow.time_step),
      stepper_(make_stepper(flow.laws, {solver, rule, {}, threads}, any_solvers(solver))) {}

StepReport Replay::operator()(const FlowStep& step) {
  work_ = step;
  std::optional<EnergyLedger> no_ledger;
  return stepper_->advance({laws_, work_.bodies, work_.memory, {}, no_ledger}, work_.walls, time_step_);
}

double peak_memory_mb(const Scene& like, int discs, const std::filesystem::path& cache) {
  const Scene scene = drum_of(like, discs);
  (void)flowing_state(scene, cache);  // so that the process only reads it
  // A program of its own would not inherit what this one has in memory; called first, there is little.
  const auto work = [&]() noexcept {
    Simulation simulation(scene, flowing_state(scene, cache));
    for (int k = 0; k < 100 && !simulation.finished(); ++k) (void)simulation.step();
  };
  const pid_t copy = ::fork();
  if (copy == 0) {
    work();
    ::_exit(0);
  }
  int status = 0;
  rusage usage{};
  if (::wait4(copy, &status, 0, &usage) != copy || status != 0)
    throw IoError("the process that shows how much memory a drum takes failed");
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

}  // namespace drumlin::benchmark
