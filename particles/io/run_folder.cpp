#include "particles/io/run_folder.hpp"

#include <fmt/format.h>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/input_file.hpp"
#include "coupling/core/results/run_records.hpp"
#include "particles/io/snapshot_file.hpp"
#include "particles/io/snapshot_list.hpp"
#include "particles/scene/scene_file.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::particles {

namespace fs = std::filesystem;

std::vector<std::string> grain_list_names(const Scene& scene) {
  std::vector<std::string> names;
  if (std::holds_alternative<ListedGrains>(scene.grains.source)) names.push_back(grain_list);
  for (std::size_t g = 0; g < scene.grains.groups.size(); ++g)
    if (std::holds_alternative<ListedGrains>(scene.grains.groups[g].source))
      names.push_back(fmt::format("grains-{}.csv", g + 1));
  return names;
}

Scene as_recorded(Scene scene) {
  const auto names = grain_list_names(scene);
  const auto lists = lists_of(scene);
  for (std::size_t k = 0; k < lists.size(); ++k) lists[k]->file = names[k];
  return scene;
}

RunFolder read_run_folder(const fs::path& folder) {
  if (!fs::is_directory(input_status(folder))) throw InputError(folder.string() + ": no such folder");
  if (!fs::exists(folder / "run.json"))
    throw InputError(folder.string() + ": holds no run.json, so no particle run");
  RunFolder result;
  result.folder = folder;
  result.files = open_result_folder(folder);
  const auto run = read_record<RunRecord>(checked_file(result.files, "run.json"));
  if (run.imported.value_or(false))
    throw InputError(
        folder.string() +
        ": is an imported run, which has no scene (drumlin measure and drumlin export --to read it)");
  result.scene = read_scene(checked_file(result.files, "scene.toml"));
  result.scales = scales_of(result.scene);
  const auto status = enumerator<RunStatus>(run.status);
  if (!status) throw InputError((folder / "run.json").string() + ": status: is not known");
  result.status = *status;
  result.snapshots = snapshot_files(folder);
  return result;
}

Snapshot checked_snapshot(const RunFolder& run, const fs::path& file) {
  return read_snapshot(checked_file(run.files, "snapshots/" + file.filename().string()));
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

namespace {

/// Of each wall, by its motions up to `time` since the start of the run.
std::vector<Pose> poses_by_motion(Walls walls, const Scene& scene, const Scales& scales, double time) {
  const TimePlan plan = time_plan(scene, scales);
  double begin = 0, length = 0;
  for (std::size_t s = 0; s < plan.stages.size(); ++s) {
    // At the end of a stage the next one would give the same poses.
    if (s > 0 && time <= begin + length) break;
    begin_stage(walls, scene.stages[s], scales, length);
    begin += length;
    length = static_cast<double>(plan.stages[s].steps) * plan.stages[s].time_step;
  }
  std::vector<Pose> poses;
  for (std::size_t w = 0; w < walls.names.size(); ++w)
    poses.push_back(walls.pose(static_cast<int>(w), time - begin));
  return poses;
}

}  // namespace

std::vector<fs::path> chosen_snapshots(const RunFolder& run, const std::string& list) {
  return listed_snapshots(run.folder, run.snapshots, "--snapshots", list);
}

std::vector<PlacedShape> shapes_at(const RunFolder& run, const Snapshot& snapshot) {
  const Walls walls = walls_of(run.scene, run.scales);
  std::vector<Pose> poses;
  for (std::size_t w = 0; w < snapshot.wall_pose_angle.size(); ++w)
    poses.push_back({snapshot.wall_pose_angle[w], snapshot.wall_pose_x[w], snapshot.wall_pose_z[w]});
  if (!moves_walls_by_force(run.scene) && !ends_stages_early(run.scene))
    poses = poses_by_motion(walls, run.scene, run.scales, snapshot.time);
  const auto& open = snapshot.wall_open;
  if (poses.size() != walls.names.size() || (opens_walls(run.scene) && open.size() != poses.size()))
    throw InputError(fmt::format("{}: a snapshot tells where {} walls are, the scene has {}",
                                 run.folder.string(), poses.size(), walls.names.size()));
  std::vector<PlacedShape> placed;
  for (std::size_t s = 0; s < walls.reference.size(); ++s) {
    const Pose& pose = poses[walls.wall_of_shape[s]];
    if (!open.empty() && open[walls.wall_of_shape[s]] != 0)
      placed.push_back({Opened{}, pose.angle});
    else
      placed.push_back({moved(Rigid(pose), walls.reference[s]), pose.angle});
  }
  return placed;
}

}  // namespace drumlin::particles
