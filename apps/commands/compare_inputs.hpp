#pragma once
// The two sides of `drumlin compare` as they are read from their folders, RUN or FLOWRUN each.
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "coupling/comparison/comparison.hpp"
#include "coupling/core/results/measured_run.hpp"

namespace drumlin::apps {

/// One folder, read.
struct LoadedSide {
  coupling::ComparedSide compared;
  RunSide kind = RunSide::particles;
  std::string name;  ///< of the folder
  std::filesystem::path folder;
  Scales scales;
  std::vector<std::string> unsteady;  ///< why it is not steady, where that was accepted
  std::filesystem::path maps_file;    ///< empty where there is none
  std::filesystem::path snapshot;     ///< the last one; empty where there is none
  std::vector<std::filesystem::path>
      moving;                         ///< snapshots that show it in motion; empty where there are none
  std::vector<std::string> accepted;  ///< edits by hand (accepted_edits)
};

/// Whether the snapshots that show a run in motion are looked for and checked.
enum class MovingSnapshots { leave, find };

/// Throws InputError on whatever read_measured_run and read_flow_run refuse, and on maps of another frame
/// than the profiles beside them.
LoadedSide load_side(const std::filesystem::path& folder, Unsteady unsteady,
                     MovingSnapshots moving = MovingSnapshots::find);

/// Throws InputError unless both sides have the same units (d, g, rho0 to 1e-3).
void require_same_scales(const LoadedSide& first, const LoadedSide& second);

/// The JSON files that the program left of this side: run and measured, or flow; an object each, or null.
nlohmann::ordered_json records_of(const LoadedSide& side);

}  // namespace drumlin::apps
