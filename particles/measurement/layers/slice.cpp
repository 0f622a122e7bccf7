#include "particles/measurement/layers/slice.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace drumlin::particles {
namespace {

using Of = LayerValues;

struct Derivative {
  double Of::*slope;
  double Of::*value;
};
constexpr Derivative along_x[] = {{&Of::d_nu_dx, &Of::nu},
                                  {&Of::d_v_x_dx, &Of::v_x},
                                  {&Of::d_v_z_dx, &Of::v_z},
                                  {&Of::d_sigma_zz_dx, &Of::sigma_zz},
                                  {&Of::d_sigma_xx_dx, &Of::sigma_xx},
                                  {&Of::d_sigma_xz_dx, &Of::sigma_xz},
                                  {&Of::d_k_dx, &Of::k}};
constexpr Derivative along_z[] = {{&Of::d_sigma_zz_dz, &Of::sigma_zz},
                                  {&Of::d_sigma_xx_dz, &Of::sigma_xx},
                                  {&Of::d_sigma_xz_dz, &Of::sigma_xz}};

/// The layer at a height; nothing but NaN where there is none.
LayerValues layer_at(const Profile& profile, double z) {
  constexpr double same_height = 1e-6;  // d: grids have their layers at the same heights but for rounding
  const auto found =
      std::find_if(profile.layers.begin(), profile.layers.end(),
                   [&](const LayerValues& layer) { return std::abs(layer.z - z) < same_height; });
  return found == profile.layers.end() ? LayerValues{} : *found;
}

Profile with_gradients(Profile centre, const Profile& west, const Profile& east, double distance) {
  auto& layers = centre.layers;
  centre.known.gradients = true;
  for (std::size_t l = 0; l < layers.size(); ++l) {
    const LayerValues before = layer_at(west, layers[l].z), behind = layer_at(east, layers[l].z);
    for (const auto& [slope, value] : along_x)
      layers[l].*slope = (behind.*value - before.*value) / (2 * distance);
    if (l == 0 || l + 1 == layers.size()) continue;
    const LayerValues &below = layers[l - 1], &above = layers[l + 1];
    for (const auto& [slope, value] : along_z)
      layers[l].*slope = (above.*value - below.*value) / (above.z - below.z);
  }
  return centre;
}

}  // namespace

Slice empty_slice(LayerGrid grid, std::size_t batches) {
  const LayerSums empty{std::vector<LayerSum>(grid.layers()), {}};
  return Slice{std::move(grid), std::vector<LayerSums>(batches, empty)};
}

LayerGrid height_grid(double x_from, double x_to, const Rectangle& reach, double thickness) {
  return layer_grid(FlowFrame{}, (x_from + x_to) / 2, x_to - x_from, thickness, reach.z_min, reach.z_max, 0,
                    0);
}

LayerGrid width_grid(double z_from, double z_to, const Rectangle& reach, double thickness) {
  return layer_grid(FlowFrame{0, 0, 0, -1}, -(z_from + z_to) / 2, z_to - z_from, thickness, reach.x_min,
                    reach.x_max, 0, 0);
}

LeaveOneOut<Profile> slice_profiles(const Slice& slice, double surface_nu) {
  return each_of(
      [&](const LayerSums& sums) {
        const double surface = surface_height(slice.grid, sums, surface_nu);
        return profile_of(slice.grid, sums, std::isfinite(surface) ? surface : 0);
      },
      leave_one_out(slice.batches));
}

LeaveOneOut<Profile> slice_profiles(const Slice& slice, const LeaveOneOut<Profile>& surfaces) {
  return each_of([&](const LayerSums& sums,
                     const Profile& surface) { return profile_of(slice.grid, sums, surface.surface_z); },
                 leave_one_out(slice.batches), surfaces);
}

void add_gradients(LeaveOneOut<Profile>& centre, const Slice& west, const Slice& east, double distance) {
  centre = each_of([&](const Profile& one, const Profile& before,
                       const Profile& behind) { return with_gradients(one, before, behind, distance); },
                   centre, slice_profiles(west, centre), slice_profiles(east, centre));
}

}  // namespace drumlin::particles
