#pragma once
// A slice of the packing: its layers summed batch by batch, and its profiles.
#include <cstddef>
#include <vector>

#include "particles/measurement/layers/profile.hpp"

namespace drumlin::particles {

/// Sums of the layers of one grid, one entry per batch of snapshots.
struct Slice {
  LayerGrid grid;
  std::vector<LayerSums> batches;
};
Slice empty_slice(LayerGrid grid, std::size_t batches);

/// Layers over the height of a band x_from ... x_to, in the axes of the scene as a silo has them. `reach`: of
/// the grains.
LayerGrid height_grid(double x_from, double x_to, const Rectangle& reach, double thickness);
/// Upright layers over the width of a band z_from ... z_to, in a frame turned by a quarter: its z is the
/// scene's x, its x points down.
LayerGrid width_grid(double z_from, double z_to, const Rectangle& reach, double thickness);

/// z = 0 where nu crosses `surface_nu`; where it never does, as with infinity, the height of the frame's
/// origin.
LeaveOneOut<Profile> slice_profiles(const Slice& slice, double surface_nu);

/// The same with z counted from the surfaces of another slice: for derivatives along x at one height.
LeaveOneOut<Profile> slice_profiles(const Slice& slice, const LeaveOneOut<Profile>& surfaces);

/// Derivatives in units of one d: of nu, v_x, v_z, sigma_zz, sigma_xx, sigma_xz and k along x, from slices
/// `distance` apart on either side; of the stresses along z from neighbouring layers. NaN where a neighbour
/// is missing. The paper, Sec. IV: slices at +-5 d.
void add_gradients(LeaveOneOut<Profile>& centre, const Slice& west, const Slice& east, double distance);

}  // namespace drumlin::particles
