#pragma once
// The scalars of one profile at the centre (docs/theory/measurement.md defines each).
#include <string>

#include "coupling/core/results/scalar_set.hpp"
#include "particles/measurement/layers/profile.hpp"

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
ScalarSet packing_scalars(const Profile& profile, const ProfilePlace& place,
                          const MeasurementOptions& options);

/// Of a packing in layers without a drum (a shear cell, a chute, a bed): means over the layers at least
/// `margin` above `wall_z` and below the highest layer that is half as dense as the densest: bulk_nu,
/// bulk_shear_rate, bulk_sigma_zz, bulk_sigma_xz, bulk_mu = sigma_xz/sigma_zz and bulk_I =
/// shear_rate/sqrt(sigma_zz) of these means. Without intervals; NaN where no layer is left. `closed`: over
/// all layers, of a cell that has neither wall nor surface.
ScalarSet bulk_scalars(const Profile& profile, double wall_z, double margin, bool closed = false);

/// Scalars of a flow down the free surface of a drum: of those that were not measured elsewhere nothing need
/// be said.
bool belongs_to_a_drum(const std::string& name);

}  // namespace drumlin::particles
