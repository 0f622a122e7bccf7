#pragma once
// The scalars of one profile at the centre (docs/theory/measurement.md defines each).
#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/scalar_set.hpp"

namespace drumlin::particles {

struct MeasurementOptions;

/// What a profile does not know of itself.
struct ProfilePlace {
  double wall_z = 0;       ///< z of the wall under the slice
  double frame_angle = 0;  ///< rad, of x below the horizontal
  bool closed = false;     ///< periodic in z: the bulk is all there is
};

/// Without intervals; NaN where the profile does not hold what a definition needs. The scalars of derivatives
/// along x only when the profile has them.
ScalarSet packing_scalars(const ProfileSet& profiles, const ProfilePlace& place,
                          const MeasurementOptions& options);

}  // namespace drumlin::particles
