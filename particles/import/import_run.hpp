#pragma once
// Import of the files of another program as snapshots.
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "particles/bodies/snapshot.hpp"
#include "particles/import/description.hpp"

namespace drumlin::particles {

struct ImportReport {
  std::size_t snapshots = 0;
  std::size_t grains = 0;    ///< of the last snapshot
  std::size_t contacts = 0;  ///< of all snapshots
  bool with_spin = false, with_contacts = false;
  double first_time_s = 0, last_time_s = 0;
  Scales scales;
  std::vector<std::string> files;
  std::vector<std::string> unused_columns;
  std::optional<double>
      unused_period_m;  ///< of a file periodic along x where the description has neither that nor a drum
  std::vector<std::string> left_out;  ///< snapshots that were not taken over, and why
};

/// The files that a description names, below `folder`. Throws InputError where there is none.
std::vector<std::filesystem::path> import_files(const ImportDescription& description,
                                                const std::filesystem::path& folder);

/// Hands the snapshots to `sink` one by one, numbered from 1 in `step`. Grains are in the order of their ids.
/// Files count from `folder`. Throws InputError (file, line) at the first fault: numbers that are none, ids
/// that stand twice, grains that come or go unannounced, lie outside of the drum or in one place, radii that
/// are not above 0, times that do not ascend, contacts of grains that there are not. A snapshot that is
/// written twice and a last one that is cut off are left out, and told.
ImportReport import_run(const ImportDescription& description, const std::filesystem::path& folder,
                        const std::function<void(const Snapshot&)>& sink);

}  // namespace drumlin::particles
