#pragma once
// `drumlin run`: a particle run from a scene to snapshots, log and run.json.
#include "apps/command_line/command.hpp"
#include "apps/output/program.hpp"

namespace drumlin::particles {
class World;
}

namespace drumlin::apps {

struct RunOptions {
  std::filesystem::path scene;
  std::filesystem::path output;
  std::vector<std::string> overrides;
  int threads = processors_at_hand();
  std::optional<int> ranks;  ///< MPI ranks that take the steps; absent: this process alone
  std::optional<std::filesystem::path> accuracy;           ///< absent: a shipped record, if there is one
  std::optional<double> accuracy_seconds, extend_seconds;  ///< simulated
  ExistingOutput existing = ExistingOutput::refuse;

  void describe(Description& d) {
    d.scene(scene, "Scene file");
    d.output(output, "RUN", "Folder for the results");
    d.changes(overrides);
    d.add("--threads", threads, "", at_least(1, most_threads),
          "Threads, all processors unless told; the results do not depend on it")
        .decides(Decides::nothing);
    d.add("--ranks", ranks, "", at_least(1, 1024),
          "Runs on so many MPI ranks of this machine, each with its share of the threads (starts "
          "drumlin-run); the results do not depend on how many (docs/scaling.md)")
        .decides(Decides::nothing);
    d.accuracy(accuracy);
    d.add("--accuracy-seconds", accuracy_seconds, "s", above(0),
          "Ends with stretches of so many simulated seconds: as the scene is, with half the time step and "
          "with a third of the tolerance; what they differ by tells the errors of the run (docs/cost.md)");
    d.add("--extend", extend_seconds, "s", above(0),
          "Prolongs the last stage of the finished run in RUN, whose scene is RUN/scene.toml, by so many "
          "simulated seconds, in whole intervals of its snapshots");
    d.existing(existing, "Continues from the last checkpoint; starts over if there is none");
  }
};

/// `world`: ranks that follow this one; none: this process alone.
int run(const RunOptions&, particles::World* world = nullptr);
/// Starts `drumlin-run`, which stands beside the running executable, by mpirun with the same words; returns
/// the exit code of the job.
int run_by_mpirun(const RunOptions&);

Command run_command();

}  // namespace drumlin::apps
