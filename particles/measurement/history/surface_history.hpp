#pragma once
// The angle of the free surface at one instant: of the grains in a drum over time, of a heap its angle of
// repose (docs/formats/history.md).
#include <limits>

#include "particles/bodies/snapshot.hpp"

namespace drumlin::particles {

/// Angles below the horizontal, which is across gravity; rad. NaN: there is none, as without gravity, in a
/// periodic domain, or where too few grains touch anything.
struct SurfaceState {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double angle = none;       ///< of the surface, positive where it falls towards +x
  double mass_angle = none;  ///< of a drum: of the line from its axis to the centre of mass, signs as above
  /// Of the two flanks of a heap, positive where they fall away from its top, and their mean. Without a
  /// circular container alone.
  double left = none, right = none, repose = none;
};

/// Of a snapshot that knows its contacts, the grains in flight are left out.
SurfaceState surface_state(const Snapshot& snapshot);

}  // namespace drumlin::particles
