#pragma once
// A slice of the packing: its layers summed batch by batch, and its profiles with intervals.
#include <cstddef>
#include <vector>

#include "coupling/exchange/profile_set.hpp"
#include "particles/measurement/layers/layer_sums.hpp"

namespace drumlin::particles {

/// Sums of the layers of one grid, one entry per batch of snapshots.
struct Slice {
  LayerGrid grid;
  std::vector<LayerSums> batches;
};

Slice empty_slice(LayerGrid grid, std::size_t batches);
LayerSums total_of(const std::vector<LayerSums>& batches);
LayerSums total_of(const Slice& slice);

/// Profiles of a slice, and the same without one batch each.
struct SliceProfiles {
  ProfileSet profiles;
  std::vector<ProfileSet> leave_one_out;  ///< empty with fewer than two batches
  double surface_z = 0;                   ///< of z = 0 in the frame of the grid
  std::vector<double> leave_one_out_surface_z;
};

/// z = 0 where nu crosses `surface_nu`; where it never does, the height of the frame's origin. Without
/// intervals: add_intervals() gives them once all columns are there.
SliceProfiles slice_profiles(const Slice& slice, double surface_nu);

/// The same with z counted from the surfaces of another slice: for derivatives along x at one height.
SliceProfiles slice_profiles(const Slice& slice, const SliceProfiles& surfaces);

/// The columns' 99 % half widths from the profiles without one batch each; `count` has none.
void add_intervals(SliceProfiles& measured);

/// Derivatives in units of one d, added as columns d_NAME_dx and d_NAME_dz: of nu, v_x, v_z, sigma_zz,
/// sigma_xx, sigma_xz and k along x, from slices `distance` apart on either side; of the stresses along z
/// from neighbouring layers. NaN where a neighbour is missing. The paper, Sec. IV: slices at +-5 d.
void add_gradients(SliceProfiles& centre, const SliceProfiles& west, const SliceProfiles& east,
                   double distance);

}  // namespace drumlin::particles
