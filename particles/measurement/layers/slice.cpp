#include "particles/measurement/layers/slice.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/layers/layer_profiles.hpp"

namespace drumlin::particles {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Calls `make` for all snapshots and then without one batch each.
template <class Make>
void for_each_choice(const Slice& slice, const Make& make) {
  const LayerSums total = total_of(slice);
  make(total);
  if (slice.batches.size() < 2) return;
  for (const LayerSums& batch : slice.batches) {
    LayerSums rest = total;
    rest -= batch;
    make(rest);
  }
}

/// Layer of `other` at the height z, or its size if it has none there.
std::size_t layer_at(const ProfileSet& other, double z) {
  constexpr double same_height =
      1e-6;  // d; both grids have their layers at the same heights but for rounding
  for (std::size_t l = 0; l < other.z.size(); ++l)
    if (std::abs(other.z[l] - z) < same_height) return l;
  return other.z.size();
}

void add_gradient_columns(ProfileSet& centre, const ProfileSet& west, const ProfileSet& east,
                          double distance) {
  std::vector<std::size_t> west_layer, east_layer;
  for (double z : centre.z) {
    west_layer.push_back(layer_at(west, z));
    east_layer.push_back(layer_at(east, z));
  }
  for (const char* name : {"nu", "v_x", "v_z", "sigma_zz", "sigma_xx", "sigma_xz", "k"}) {
    const auto &before = west.column(name).value, &behind = east.column(name).value;
    std::vector<double> slope(centre.z.size(), none);
    for (std::size_t l = 0; l < slope.size(); ++l)
      if (west_layer[l] < before.size() && east_layer[l] < behind.size())
        slope[l] = (behind[east_layer[l]] - before[west_layer[l]]) / (2 * distance);
    centre.columns.push_back({std::string("d_") + name + "_dx", std::move(slope), {}});
  }
  for (const char* name : {"sigma_zz", "sigma_xx", "sigma_xz"}) {
    const auto& value = centre.column(name).value;
    std::vector<double> slope(centre.z.size(), none);
    for (std::size_t l = 1; l + 1 < slope.size(); ++l)
      slope[l] = (value[l + 1] - value[l - 1]) / (centre.z[l + 1] - centre.z[l - 1]);
    centre.columns.push_back({std::string("d_") + name + "_dz", std::move(slope), {}});
  }
}

}  // namespace

Slice empty_slice(LayerGrid grid, std::size_t batches) {
  const LayerSums empty{std::vector<LayerSum>(grid.layers()), 0, true};
  return Slice{std::move(grid), std::vector<LayerSums>(batches, empty)};
}

LayerSums total_of(const Slice& slice) { return total_of(slice.batches); }

LayerSums total_of(const std::vector<LayerSums>& batches) {
  LayerSums total = batches.front();
  for (std::size_t b = 1; b < batches.size(); ++b) {
    total += batches[b];
    total.with_spin = total.with_spin && batches[b].with_spin;
    total.with_densities = total.with_densities || batches[b].with_densities;
    total.with_contacts = total.with_contacts && batches[b].with_contacts;
  }
  return total;
}

SliceProfiles slice_profiles(const Slice& slice, double surface_nu) {
  SliceProfiles measured;
  bool first = true;
  for_each_choice(slice, [&](const LayerSums& sums) {
    double surface = surface_height(slice.grid, sums, surface_nu);
    if (!std::isfinite(surface)) surface = 0;
    ProfileSet profiles = layer_profiles(slice.grid, sums, surface);
    if (std::exchange(first, false)) {
      measured.surface_z = surface;
      measured.profiles = std::move(profiles);
    } else {
      measured.leave_one_out_surface_z.push_back(surface);
      measured.leave_one_out.push_back(std::move(profiles));
    }
  });
  return measured;
}

SliceProfiles slice_profiles(const Slice& slice, const SliceProfiles& surfaces) {
  SliceProfiles measured{{}, {}, surfaces.surface_z, surfaces.leave_one_out_surface_z};
  bool first = true;
  for_each_choice(slice, [&](const LayerSums& sums) {
    if (std::exchange(first, false))
      measured.profiles = layer_profiles(slice.grid, sums, surfaces.surface_z);
    else
      measured.leave_one_out.push_back(
          layer_profiles(slice.grid, sums, surfaces.leave_one_out_surface_z[measured.leave_one_out.size()]));
  });
  return measured;
}

void add_intervals(SliceProfiles& measured) {
  ProfileSet& profiles = measured.profiles;
  for (std::size_t c = 0; c < profiles.columns.size(); ++c) {
    ProfileColumn& column = profiles.columns[c];
    if (column.name == "count") continue;
    for (std::size_t l = 0; l < profiles.z.size(); ++l) {
      std::vector<double> values;
      for (const ProfileSet& one : measured.leave_one_out)
        values.push_back(l < one.z.size() ? one.columns[c].value[l] : none);
      column.ci99.push_back(jackknife_ci99(values));
    }
  }
}

void add_gradients(SliceProfiles& centre, const SliceProfiles& west, const SliceProfiles& east,
                   double distance) {
  add_gradient_columns(centre.profiles, west.profiles, east.profiles, distance);
  for (std::size_t b = 0; b < centre.leave_one_out.size(); ++b)
    add_gradient_columns(centre.leave_one_out[b], west.leave_one_out[b], east.leave_one_out[b], distance);
}

}  // namespace drumlin::particles
