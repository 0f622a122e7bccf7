#include "apps/commands/cost/long_run.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands/cost/sweep.hpp"
#include "apps/commands/run_files.hpp"
#include "apps/support/interruption.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/output_folder.hpp"
#include "coupling/common/machine_load.hpp"
#include "coupling/common/text_file.hpp"
#include "particles/io/checkpoint_file.hpp"
#include "particles/scene/scene_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr double snapshots_per_second = 40;  // as in the paper: 400 over a turn of 10 s
constexpr int least_snapshots = 40;          // two in each of the twenty batches of an interval

void succeed(int exit_code) {
  if (exit_code != 0) throw Interrupted{exit_code};
}

/// The state as a checkpoint of the run, so that `drumlin run --resume` goes on from it.
void lay_down(const particles::SweepStart& start, const particles::Scene& scene, const fs::path& run) {
  const GrowingOutput marked({run, ExistingOutput::resume, "run", {}}, run_file_names());
  particles::Checkpoint checkpoint;
  checkpoint.scene = particles::scene_text(as_recorded(scene));
  checkpoint.state = start.state;
  particles::write_checkpoint(run / "checkpoint.h5", checkpoint);
}

}  // namespace

Json long_run(const particles::SweepStart& start, particles::Scene scene, const fs::path& folder,
              int threads) {
  const double seconds = particles::duration_s(scene.stages.back());
  scene.stages.back().snapshots =
      std::max(least_snapshots, static_cast<int>(std::lround(snapshots_per_second * seconds)));
  const fs::path file = folder / "scene.toml", run_folder = folder / "run";
  const double load = load_average();
  if (!fs::exists(run_folder / "checkpoint.h5")) {
    lay_down(start, scene, run_folder);
    replace_file(file, particles::scene_text(scene));
  }
  RunOptions asked;
  asked.scene = file, asked.output = run_folder, asked.threads = threads;
  asked.existing = ExistingOutput::resume;
  // A run most of whose steps missed a tolerance is a point of the sweep like others, which says so.
  if (const int code = run(asked); code != static_cast<int>(ExitCode::not_converged)) succeed(code);
  MeasureOptions measuring;
  measuring.run = run_folder;
  measuring.parts = {"none"};
  measuring.existing = ExistingOutput::resume;
  succeed(measure(measuring));

  const Json ran = read_json(run_folder / "run.json", "drumlin-run-1");
  const Json measured = read_json(run_folder / "measured" / "measured.json", "drumlin-measured-1");
  const double all = ran.at("steps").get<double>(), own = all - static_cast<double>(start.state.step);
  Json statistics{{"simulated_seconds", seconds},
                  {"cpu_seconds", ran.at("cpu_seconds")},
                  {"steps", own},
                  {"sweeps_mean", ran.at("cost").at("sweeps_mean").get<double>() * all / own},
                  {"missed_share", ran.at("unconverged_steps").get<double>() / own},
                  {"load_before", load}};
  Json scalars = Json::object();
  for (const auto& [key, value] : measured.items())
    if (value.is_object() && value.contains("value") && value.contains("ci99"))
      scalars[key] = {{"value", value.at("value")}, {"ci99", value.at("ci99")}};
  statistics["scalars"] = scalars;
  fs::remove_all(folder);
  return {{"statistics", statistics}};
}

}  // namespace drumlin::apps
