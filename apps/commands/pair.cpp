// drumlin pair: both sides of one particle scene, and their report, which drumlin/pair/command.py of the
// Python package makes.
#include <nlohmann/json.hpp>

#include "apps/command_line/command.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/program.hpp"
#include "apps/output/results.hpp"
#include "apps/process/program_files.hpp"
#include "apps/process/request_sum.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/law/rheology_file.hpp"
#include "particles/io/run_folder.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct PairOptions {
  fs::path scene, law, output;
  std::vector<std::string> overrides;
  std::vector<double> at;  ///< s; empty: of the snapshots
  int seeds = 1, threads = processors_at_hand();
  std::vector<fs::path> runs;  ///< empty: made
  std::string limits_case = "any", executor = "local:1";
  bool scene_only = false, accept_unsteady = false;
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.scene(scene, "Particle scene");
    d.law("--law", law, "Law of the continuum").required();
    d.output(output, "DIR", "Folder for flow.toml, runs, flow and report");
    d.changes(overrides);
    d.add("--seeds", seeds, "", at_least(1, 100), "Runs of the scene, each with another seed");
    d.add("--executor", executor, "WORKERS",
          "Where they are computed: local, local:N (so many at once), or dask:ADDRESS of a scheduler")
        .decides(Decides::nothing);
    d.add("--run", runs, "RUN", "Finished runs of the scene, in place of new ones");
    d.add(
        "--at", at, "TIMES", at_least(0),
        "Seconds since the flow begins at which both sides are compared; absent: up to 40 of the snapshots");
    d.add("--case", limits_case, "NAME",
          "Which limits of data/limits/pair.toml judge it, beside those of any pair");
    d.add("--scene-only", scene_only, "Leaves the flow scene alone; without --run its material is level");
    d.add("--accept-unsteady", accept_unsteady, "Of layers: compares a run that is not steady, too");
    d.add("--threads", threads, "", at_least(1, most_threads), "Threads of a run").decides(Decides::nothing);
    d.existing(existing, "Goes on where an earlier call was interrupted");
  }
};

Json given_of(const PairOptions& options, const std::string& scene, const ResultsRequest& request) {
  for (const fs::path& run : options.runs) (void)particles::read_run_folder(run);
  Json given = json_of(described(options));
  given["file"] = given["scene"];
  given["scene"] = scene;
  given["nu"] = read_rheology(options.law).nu;
  given["sum"] = request.requested;
  given["limits"] = (data_folder() / "limits" / "pair.toml").string();
  return given;
}

int pair(const PairOptions& options) {
  const std::string scene = particles::scene_text(particles::read_scene(options.scene, options.overrides));
  const ResultsRequest request =
      results_of(options, "pair", options.output, "flow.toml", Json::array({scene}));
  if (is_done_already(request)) return static_cast<int>(ExitCode::done);
  return end_of_command("../pair/command.py", {given_of(options, scene, request).dump()});
}

}  // namespace

Command pair_command() {
  return command("pair", "Particles and continuum of one scene: runs both and compares them over time", pair);
}

}  // namespace drumlin::apps
