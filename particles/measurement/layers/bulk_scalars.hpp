#pragma once
// The numbers that belong to a packing in layers without a drum (a shear cell, a chute, a bed): means over
// its bulk.
#include <string>
#include <vector>

#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/scalar_set.hpp"

namespace drumlin::particles {

/// Means over the layers at least `margin` above `wall_z` and below the highest layer that is half as dense
/// as the densest: bulk_nu, bulk_shear_rate, bulk_sigma_zz, bulk_sigma_xz, bulk_mu = sigma_xz/sigma_zz and
/// bulk_I = shear_rate/sqrt(sigma_zz) of these means. Without intervals; NaN where no layer is left or a
/// column is not there. `closed`: over all layers, of a cell that has neither wall nor surface.
ScalarSet bulk_scalars(const ProfileSet& profiles, double wall_z, double margin, bool closed = false);

/// Scalars of a flow down the free surface of a drum: of those that were not measured elsewhere nothing need
/// be said.
bool belongs_to_a_drum(const std::string& name);

}  // namespace drumlin::particles
