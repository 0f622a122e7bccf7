#pragma once
// Profiles from the sums of the layers (docs/theory/measurement.md defines each column).
#include "coupling/exchange/profile_set.hpp"
#include "particles/measurement/layers/layer_sums.hpp"

namespace drumlin::particles {

/// z in the frame of the grid at which the volume fraction crosses `surface_nu`: the highest such place,
/// linear between the middles of layers. NaN when it never does. Of a cell that is periodic in z its upper
/// end.
double surface_height(const LayerGrid& grid, const LayerSums& sums, double surface_nu);

/// Profiles with z counted from `surface_z` (frame of the grid): v_x, v_z, shear_rate, half_vorticity, omega
/// (only with spin), nu, sigma_xx, sigma_zz, sigma_xz, their kinetic parts (sigma_xx_kinetic, ...),
/// sigma_rotational (only with spin), I, mu, k, dv, domega (only with spin), coordination, count. Layers
/// above the highest grain and outside the container are left out. NaN where a layer holds too little.
ProfileSet layer_profiles(const LayerGrid& grid, const LayerSums& sums, double surface_z);

}  // namespace drumlin::particles
