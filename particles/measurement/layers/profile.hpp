#pragma once
// Profiles from the sums of layers: the quantities of each layer, and which of them make a table
// (docs/theory/measurement.md defines each).
#include <limits>
#include <span>
#include <vector>

#include "coupling/core/results/profile_set.hpp"
#include "particles/measurement/frame/intervals.hpp"
#include "particles/measurement/frame/moments.hpp"
#include "particles/measurement/layers/layer_sums.hpp"

namespace drumlin::particles {

/// What is known of one layer; NaN where it holds too little. In rings x is the tangent and z the radius.
struct LayerValues : SharedFields {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();
  double z = none, v_x = none, v_z = none, shear_rate = none, half_vorticity = none, omega = none;
  double nu = none, density = none;
  double sigma_xx_kinetic = 0, sigma_zz_kinetic = 0, sigma_xz_kinetic = 0, sigma_rotational = none;
  double sigma_xx = none, sigma_zz = none, sigma_xz = none;
  double I = none, mu = none, k = none, dv = none, domega = none, count = none;
  double d_nu_dx = none, d_v_x_dx = none, d_v_z_dx = none, d_sigma_zz_dx = none, d_sigma_xx_dx = none,
         d_sigma_xz_dx = none, d_k_dx = none;
  double d_sigma_zz_dz = none, d_sigma_xx_dz = none, d_sigma_xz_dz = none;
  double nu_voronoi = none, nu_grains = none;  ///< area of discs over area of cells, mean of the grains' own
  double sigma_xx_grains = none, sigma_zz_grains = none, sigma_xz_grains = none;  ///< of contacts
};

/// What a profile has beside what all have.
struct KnownQuantities {
  bool spin = false, contacts = false, densities = false, cells = false, gradients = false;
};

struct Profile {
  std::vector<LayerValues> layers;  ///< ascending
  KnownQuantities known;
  double surface_z = 0;  ///< of z = 0 in the frame of the grid
};

/// A column of a table beside `shared_fields`: its name (coupling/core/results/quantities.hpp), where it
/// stands, what it needs and, in other axes, the sign that it takes.
struct LayerQuantity {
  const char* name;
  double LayerValues::*value;
  bool KnownQuantities::*needs = nullptr;
  double sign = 1;
};
std::span<const LayerQuantity> layer_quantities();
/// Over the distance from a point: v_t = r times the mean angular velocity of a ring, weighted by r^2, so
/// that a packing which turns as one has exactly omega r, shear_rate = r d(v_t/r)/dr, stresses as in layers.
std::span<const LayerQuantity> ring_quantities();
/// Over the height of a silo, in the axes of the scene: without the numbers of a shear flow down a surface.
std::span<const LayerQuantity> height_quantities();
/// Over its width, with the scene's components, from layers whose x points down (width_grid).
std::span<const LayerQuantity> width_quantities();

/// z in the frame of the grid at which the volume fraction crosses `surface_nu`: the highest such place,
/// linear between the middles of layers. NaN when it never does. Of a cell that is periodic in z its upper
/// end.
double surface_height(const LayerGrid& grid, const LayerSums& sums, double surface_nu);

/// With z counted from `surface_z` (frame of the grid). Layers above the highest grain and outside the
/// container are left out.
Profile profile_of(const LayerGrid& grid, const LayerSums& sums, double surface_z);

/// The quantities that a profile knows, as a table, and with the 99 % half widths of all but `count`.
ProfileSet table_of(const Profile& profile, std::span<const LayerQuantity> quantities = layer_quantities());
ProfileSet table_of(const LeaveOneOut<Profile>& profiles,
                    std::span<const LayerQuantity> quantities = layer_quantities());

}  // namespace drumlin::particles
