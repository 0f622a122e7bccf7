#pragma once
// Profiles over the distance from a point, from the sums of rings.
#include <vector>

#include "coupling/exchange/profile_set.hpp"
#include "particles/measurement/rings/ring_sums.hpp"

namespace drumlin::particles {

/// Profiles over r (in ProfileSet::z): v_t (clockwise), v_r, shear_rate = r d(v_t/r)/dr, half_vorticity,
/// omega (only with spin), nu, density (only where grains have densities of their own), sigma_rr, sigma_tt,
/// sigma_rt with their kinetic parts, I = shear_rate/sqrt(sigma_rr), mu = sigma_rt/sigma_rr, k =
/// sigma_tt/sigma_rr, coordination (only where contacts are known), count. v_t is r times the mean angular
/// velocity of the ring, weighted by r^2, so that a packing which turns as one has exactly omega r. Rings
/// beyond the outermost grain are left out. NaN where a ring holds too little.
ProfileSet ring_profiles(const RingGrid& grid, const LayerSums& sums);

/// The same with intervals, from the sums of batches.
ProfileSet ring_profiles(const RingGrid& grid, const std::vector<LayerSums>& batches);

}  // namespace drumlin::particles
