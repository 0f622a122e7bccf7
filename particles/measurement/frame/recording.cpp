#include "particles/measurement/frame/recording.hpp"

#include <string>
#include <utility>

#include "coupling/common/errors.hpp"
#include "particles/measurement/frame/flow_frame.hpp"

namespace drumlin::particles {

Snapshot Recording::read(std::size_t index) const {
  Snapshot snapshot = source->read(first + index);
  if (snapshot.x.empty()) throw InputError("snapshot " + std::to_string(first + index) + " holds no grains");
  return in_mirror ? mirrored(std::move(snapshot)) : snapshot;
}

Recording steady_recording(const SnapshotSource& source) {
  if (source.count == 0) throw InputError("the run holds no snapshots: there is nothing to measure");
  const double spin = source.read(source.count - 1).wall_spin;
  std::size_t other = 0, same = source.count - 1;  // the border between two motions lies between them
  if (source.read(0).wall_spin == spin) {
    same = 0;
  } else {
    while (same - other > 1) {
      const std::size_t middle = (other + same) / 2;
      (source.read(middle).wall_spin == spin ? same : other) = middle;
    }
  }
  return Recording{&source, same, spin < 0};
}

}  // namespace drumlin::particles
