#pragma once
// How much a run will write, said before it writes.
#include <cstdint>
#include <filesystem>
#include <string>

#include "particles/scene/scene.hpp"

namespace drumlin::apps {

/// Bytes of a run's files; of what depends on how grains touch an estimate (1.7 contacts a grain, those of a
/// flowing drum).
struct ExpectedOutput {
  double snapshot = 0;  ///< of one
  double snapshots = 0, log = 0, checkpoints = 0;
  double all() const { return snapshots + log + checkpoints; }
};

/// `snapshots`, `steps`: of the whole plan.
ExpectedOutput expected_output(const particles::Scene& scene, std::size_t grains, std::size_t snapshots,
                               std::int64_t steps);

/// "about 335 MB: 400 snapshots of 0.83 MB, log.csv of 2.1 MB, checkpoints of 1.5 MB"
std::string expected_output_text(const ExpectedOutput& expected);

/// A warning where the disk of `folder` has not that much left, else empty.
std::string room_warning(const ExpectedOutput& expected, const std::filesystem::path& folder);

}  // namespace drumlin::apps
