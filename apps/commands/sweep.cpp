// drumlin sweep: a particle scene with many settings, each a run of its own, here or on a cluster, which
// drumlin/sweeping/command.py of the Python package does.
#include <nlohmann/json.hpp>

#include "apps/command_line/command.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/program.hpp"
#include "apps/output/results.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct SweepOptions {
  fs::path scene, output;
  std::vector<std::string> vary, quantities, overrides;
  std::string executor = "local";
  bool measure = false;
  int threads = 1;
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.scene(scene, "Particle scene");
    d.add("--vary", vary, "KEY=VALUE:VALUE...",
          "Values of a key of the scene, e.g. seed=1:2:3; repeatable: every combination is run")
        .repeated()
        .required();
    d.output(output, "SWEEP", "Folder for the runs and index.html, a page that is renewed as runs end");
    d.changes(overrides);
    d.add("--measure", measure, "Measures each run");
    d.add("--quantities", quantities, "NAME,NAME,...", "What the page shows; absent: at most six numbers");
    d.add("--executor", executor, "WORKERS",
          "Where runs are computed: local, local:N (so many at once), dask:ADDRESS of a scheduler, or mpi, "
          "under mpirun (docs/cookbook/many-runs.md)")
        .decides(Decides::nothing);
    d.add("--threads", threads, "", at_least(1, most_threads), "Threads of each run")
        .decides(Decides::nothing);
    d.existing(existing, "Goes on where an earlier call was interrupted");
  }
};

int sweep(const SweepOptions& options) {
  const std::string scene = particles::scene_text(particles::read_scene(options.scene, options.overrides));
  const ResultsRequest request =
      results_of(options, "sweep", options.output, "sweep.json", Json::array({scene}));
  if (is_done_already(request)) return static_cast<int>(ExitCode::done);
  Json given = json_of(described(options));
  given["sum"] = request.requested;
  return end_of_command("../sweeping/command.py", {given.dump()});
}

}  // namespace

Command sweep_command() {
  return command("sweep", "A scene with many settings, each a run: here, or on a cluster", sweep);
}

}  // namespace drumlin::apps
