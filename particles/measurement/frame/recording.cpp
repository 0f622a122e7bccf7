#include "particles/measurement/frame/recording.hpp"

#include <string>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "particles/measurement/frame/flow_frame.hpp"

namespace drumlin::particles {

Snapshot Recording::read(std::size_t index) const {
  Snapshot snapshot = source->read(first + index);
  if (snapshot.x.empty()) throw InputError("snapshot " + std::to_string(first + index) + " holds no grains");
  return in_mirror ? mirrored(std::move(snapshot)) : snapshot;
}

namespace {

/// What drives the flow as long as a stage lasts.
struct Drive {
  double wall_spin = 0, shear = 0;
  bool operator==(const Drive&) const = default;
};

Drive drive_of(const Snapshot& snapshot) {
  return {snapshot.wall_spin, snapshot.cell ? snapshot.cell->shear : 0};
}

}  // namespace

Recording steady_recording(const SnapshotSource& source) {
  if (source.count == 0) throw InputError("the run holds no snapshots: there is nothing to measure");
  const Drive drive = drive_of(source.read(source.count - 1));
  std::size_t other = 0, same = source.count - 1;  // the border between two motions lies between them
  if (drive_of(source.read(0)) == drive) {
    same = 0;
  } else {
    while (same - other > 1) {
      const std::size_t middle = (other + same) / 2;
      (drive_of(source.read(middle)) == drive ? same : other) = middle;
    }
  }
  return Recording{&source, same, drive.wall_spin < 0};
}

}  // namespace drumlin::particles
