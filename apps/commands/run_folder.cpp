#include "apps/commands/run_folder.hpp"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "apps/support/json_file.hpp"
#include "coupling/exchange/errors.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::apps {

namespace fs = std::filesystem;

RunFolder read_run_folder(const fs::path& folder, nlohmann::ordered_json& run) {
  if (!fs::is_directory(folder)) throw InputError(folder.string() + ": no such folder");
  if (!fs::exists(folder / "run.json"))
    throw InputError(folder.string() + ": holds no run.json, so no particle run");
  run = read_json(folder / "run.json", "drumlin-run-1");
  RunFolder result;
  result.folder = folder;
  result.scene = read_scene(folder / "scene.toml");
  result.scales = scales_of(result.scene);
  const auto status = run.find("status");
  if (status == run.end() || !status->is_string())
    throw InputError((folder / "run.json").string() + ": status: missing, or no text");
  result.status = *status;
  result.snapshots = snapshot_files(folder);
  return result;
}

int snapshot_number(const fs::path& file) {
  const std::string stem = file.stem().string();
  int number = 0;
  const auto [end, fault] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  if (fault != std::errc() || end != stem.data() + stem.size())
    throw InputError(file.string() + ": is not named as a snapshot (NNNNNN.h5)");
  return number;
}

fs::path chosen_snapshot(const RunFolder& run, const std::string& name) {
  if (run.snapshots.empty()) throw InputError(run.folder.string() + ": holds no snapshots");
  if (name == "last") return run.snapshots.back();
  for (const fs::path& file : run.snapshots)
    if (std::to_string(snapshot_number(file)) == name) return file;
  throw InputError(fmt::format("{}: has no snapshot {} (allowed: {} to {}, or last)", run.folder.string(),
                               name, snapshot_number(run.snapshots.front()),
                               snapshot_number(run.snapshots.back())));
}

std::vector<PlacedShape> shapes_of(const Scene& scene, const Scales& scales, double time) {
  const TimePlan plan = time_plan(scene, scales);
  Walls walls = walls_of(scene, scales);
  double begin = 0, length = 0;
  for (std::size_t s = 0; s < plan.stages.size(); ++s) {
    // At the end of a stage the next one would give the same poses.
    if (s > 0 && time <= begin + length) break;
    const double before = length;
    begin += before;
    begin_stage(walls, scene.stages[s], scales, before);
    length = static_cast<double>(plan.stages[s].steps) * plan.stages[s].time_step;
  }
  std::vector<PlacedShape> placed;
  for (std::size_t s = 0; s < walls.reference.size(); ++s) {
    const Pose pose = walls.pose(walls.wall_of_shape[s], time - begin);
    placed.push_back({moved(Rigid(pose), walls.reference[s]), pose.angle});
  }
  return placed;
}

}  // namespace drumlin::apps
