#pragma once
// Profiles in the axes of the scene, as a silo has them: over the height within a band of x, and over the
// width within a band of z. Layers again; numbers of a shear flow down a surface are left out.
#include "coupling/exchange/profile_set.hpp"
#include "particles/measurement/layers/slice.hpp"

namespace drumlin::particles {

/// What the grains reach, in the axes of the scene.
struct SceneBox {
  double x_min = 0, x_max = 0, z_min = 0, z_max = 0;
};

/// Layers over the height of a band x_from ... x_to.
LayerGrid height_grid(double x_from, double x_to, const SceneBox& reach, double thickness);
/// Upright layers over the width of a band z_from ... z_to.
LayerGrid width_grid(double z_from, double z_to, const SceneBox& reach, double thickness);

/// Over z (ProfileSet::z), with intervals: v_x, v_z, omega, nu, density, sigma_zz, sigma_xx, sigma_xz with
/// their kinetic parts, k = sigma_xx/sigma_zz, coordination, count; those that the snapshots know.
ProfileSet height_profiles(const Slice& slice);
/// Over x (ProfileSet::z), the same with d_v_z_dx in place of k.
ProfileSet width_profiles(const Slice& slice);

}  // namespace drumlin::particles
