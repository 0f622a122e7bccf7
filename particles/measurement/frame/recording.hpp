#pragma once
// The snapshots of a run that are measured: those under its last motion of the wall, from some time on.
#include <cstddef>
#include <functional>
#include <optional>

#include "particles/bodies/snapshot.hpp"

namespace drumlin::particles {

/// Snapshots in order of time, fetched one by one: a long run does not fit in memory.
struct SnapshotSource {
  std::size_t count = 0;
  std::function<Snapshot(std::size_t)> read;
};

/// The part of a source that is measured. A drum that turns anticlockwise is seen in a mirror.
struct Recording {
  const SnapshotSource* source = nullptr;  ///< outlives the recording
  std::size_t first = 0;                   ///< snapshots before it are another motion's, or too early
  bool in_mirror = false;
  std::size_t count() const { return source->count - first; }
  /// Throws InputError when the snapshot holds no grains.
  Snapshot read(std::size_t index) const;
};

/// The last snapshots with one and the same motion of the wall, and shear of the cell, from that time (s)
/// on: pictures of the settling are not steady flow. Throws InputError when there is none.
Recording steady_recording(const SnapshotSource& source, std::optional<double> since_s = {});

}  // namespace drumlin::particles
