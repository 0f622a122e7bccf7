// drumlin cost: what accuracy costs, and what each effect. All of it is the scripts of apps/costs, which
// reach what they measure by the compiled part of the Python package.
#include "apps/command_line/command.hpp"
#include "apps/output/figures.hpp"
#include "apps/process/interruption.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;

struct CostOptions {
  fs::path scene;                  ///< of particles or of a flow
  std::vector<std::string> sweep;  ///< "tolerance" or "tolerance=1e-2:1e-3"; empty: all that the scene has
  std::optional<double> horizon_s, statistics_s, time_limit_s;
  std::optional<fs::path> from, rheology, output;
  std::vector<int> ranks = {1};
  std::vector<std::string> neighbour, variants, overrides;
  int repeats = 1, threads = 1;
  bool effects = false;  ///< the price list of the scene's effects, in place of a sweep
  std::vector<fs::path> against;
  double seconds = 1;  ///< of --effects, simulated, from the start of the scene
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.scene(scene, "Scene of particles or of a flow", shipped_scene_of_any_kind);
    d.add("--sweep", sweep, "NAME[=VALUE:...],...",
          "What is varied, each with its values or standard ones, e.g. tolerance=1e-2:1e-3,step; particles: "
          "solver, tolerance, step; flows: mesh, eps, tolerance [all]");
    d.add("--horizon", horizon_s, "s", above(0),
          "Particles: longest stretch after which velocities are compared; half or a quarter of it where the "
          "finest point leaves the reference earlier; standard: 16 steps of the scene");
    d.add("--statistics", statistics_s, "s", above(0),
          "Particles: compares the measured numbers of runs of this length as well");
    d.add("--from", from, "RUN",
          "Particles: finished run of the scene to start from; standard: the beginning of the last stage, "
          "which "
          "is run up to first");
    d.law("--rheology", rheology, "Flows: law");
    d.add("--ranks", ranks, "N,N,...", at_least(1, 1024),
          "Flows: numbers of MPI processes on which each is solved, its times listed; standard: 1");
    d.add("--neighbour", neighbour, "KEY=VALUE",
          "Flows: each is also solved from the flow with this change, e.g. drum.rotation_rpm=5; repeatable")
        .repeated();
    d.add("--repeats", repeats, "", at_least(1, 100),
          "Flows: solves of each, of which the least and the median time are listed");
    d.add("--time-limit", time_limit_s, "s", above(0), "Flows: wall time after which one is given up");
    d.add(
        "--effects", effects,
        "In place of a sweep: the scene with each of its effects removed and each absent one added; seconds, "
        "unknowns and results of each");
    d.add("--variants", variants, "LIST",
          "With --effects, flows: which effects together, e.g. inertia,inertia+k; standard: each alone");
    d.add("--against", against, "RUN",
          "With --effects, flows of a drum: measured runs of its speed; the errors of each variant against "
          "them");
    d.output(output, "COST",
             "Folder for cost.json, its points and figures; --effects of particles can do without");
    d.changes(overrides);
    d.add("--seconds", seconds, "s", above(0),
          "With --effects, particles: simulated time from the start of the scene");
    d.add("--threads", threads, "", at_least(1, most_threads), "Threads; the results do not depend on it");
    d.existing(existing, "Keeps the points that an earlier call has finished");
  }
};

int cost(const CostOptions& options) {
  if (options.output) outlive_readers();
  return end_of_command("../costs/cost.py", {json_of(described(options)).dump()});
}

}  // namespace

Command cost_command() {
  return command("cost", "What accuracy costs in a scene, or its effects (docs/cost.md)", cost);
}

}  // namespace drumlin::apps
