#pragma once
// Scalars of one particle profile: those shared with the continuum and those that only grains have.
#include "coupling/exchange/scalar_set.hpp"
#include "particles/measurement/measurement.hpp"

namespace drumlin {

/// Q, H, lambda, shear_rate, I_th, nu_bulk, spin_over_half_vorticity, dv_over_shear, domega_over_shear,
/// k_flowing, spin_over_half_curl, without intervals; NaN where the profile does not hold what one
/// needs. wall_z: z of the wall below the slice, from the surface.
ScalarSet packing_scalars(const ProfileSet& profiles, double wall_z, const MeasurementOptions& options);

}  // namespace drumlin
