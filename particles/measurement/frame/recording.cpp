#include "particles/measurement/frame/recording.hpp"

#include <fmt/format.h>

#include <limits>
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

Recording steady_recording(const SnapshotSource& source, std::optional<double> since_s) {
  if (source.count == 0) throw InputError("the run holds no snapshots: there is nothing to measure");
  const Snapshot last = source.read(source.count - 1);
  const Drive drive = drive_of(last);
  const double second = last.scales.time_s, rounding = 1e-9;
  const double since =
      since_s ? *since_s / second * (1 - rounding) : -std::numeric_limits<double>::infinity();
  if (!(last.time >= since))
    throw InputError({InputProblem{"", 0, 0, "--since", fmt::format("is {:g}", *since_s),
                                   fmt::format("at most {:g} s, the last snapshot", last.time * second)}});
  const auto counts = [&](std::size_t index) {
    const Snapshot snapshot = source.read(index);
    return drive_of(snapshot) == drive && snapshot.time >= since;
  };
  std::size_t other = 0, same = source.count - 1;  // the first that counts lies between them
  if (counts(0)) {
    same = 0;
  } else {
    while (same - other > 1) {
      const std::size_t middle = (other + same) / 2;
      (counts(middle) ? same : other) = middle;
    }
  }
  return Recording{&source, same, drive.wall_spin < 0};
}

}  // namespace drumlin::particles
