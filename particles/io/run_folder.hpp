#pragma once
// The folder of a particle run, finished or not: its scene, its state, its snapshots and where its walls
// stand.
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/core/basics/run_status.hpp"
#include "coupling/core/basics/scales.hpp"
#include "coupling/core/files/result_folder.hpp"
#include "particles/bodies/snapshot.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// The file in a run folder that holds a copy of the grain list of its scene.
inline constexpr const char* grain_list = "grains.csv";
/// Names of the files in a run folder that hold copies of the scene's lists of grains, in the order of
/// lists_of().
std::vector<std::string> grain_list_names(const Scene& scene);
/// The scene as it stands in the run folder.
Scene as_recorded(Scene scene);

struct RunFolder {
  std::filesystem::path folder;
  ResultFolder files;
  Scene scene;  ///< resolved, from scene.toml
  Scales scales;
  RunStatus status = RunStatus::running;         ///< of run.json
  std::vector<std::filesystem::path> snapshots;  ///< in order of their numbers

  bool finished() const { return status == RunStatus::finished; }
};

/// Throws InputError if the folder is missing, is no run or an imported one, is not as its manifest says, or
/// holds a scene that this version does not read.
RunFolder read_run_folder(const std::filesystem::path& folder);

/// One of `snapshots`, read; refused if it is not as the manifest says. Throws InputError.
Snapshot checked_snapshot(const RunFolder& run, const std::filesystem::path& file);

/// The file of a snapshot by its number or "last". Throws InputError that says which there are.
std::filesystem::path chosen_snapshot(const RunFolder& run, const std::string& name);

/// Those of a list: "all", "last", or numbers and ranges as in "1,5,10-20"; each once, in order. Throws
/// InputError if the list cannot be read, or names one that is not there.
std::vector<std::filesystem::path> chosen_snapshots(const RunFolder& run, const std::string& list);

/// A wall shape where it stands at one instant.
struct PlacedShape {
  Shape shape;       ///< d
  double angle = 0;  ///< rad turned since the start, positive clockwise as drawn
};
/// All wall shapes at the time of a snapshot, in the order of the indices in its contacts. Throws InputError
/// when the snapshot is not of this scene.
std::vector<PlacedShape> shapes_at(const RunFolder& run, const Snapshot& snapshot);

}  // namespace drumlin::particles
