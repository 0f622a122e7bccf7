#include "particles/measurement/layers/profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "coupling/core/results/layer_ratios.hpp"
#include "particles/measurement/layers/layer_motion.hpp"

namespace drumlin::particles {
namespace {

using Of = LayerValues;
using Known = KnownQuantities;

constexpr LayerQuantity of_layers[] = {{"v_x", &Of::v_x},
                                       {"v_z", &Of::v_z},
                                       {"shear_rate", &Of::shear_rate},
                                       {"half_vorticity", &Of::half_vorticity},
                                       {"omega", &Of::omega, &Known::spin},
                                       {"nu", &Of::nu},
                                       {"density", &Of::density, &Known::densities},
                                       {"sigma_xx_kinetic", &Of::sigma_xx_kinetic},
                                       {"sigma_zz_kinetic", &Of::sigma_zz_kinetic},
                                       {"sigma_xz_kinetic", &Of::sigma_xz_kinetic},
                                       {"sigma_rotational", &Of::sigma_rotational, &Known::spin},
                                       {"sigma_xx", &Of::sigma_xx},
                                       {"sigma_zz", &Of::sigma_zz},
                                       {"sigma_xz", &Of::sigma_xz},
                                       {"I", &Of::I},
                                       {"mu", &Of::mu},
                                       {"k", &Of::k},
                                       {"dv", &Of::dv},
                                       {"domega", &Of::domega, &Known::spin},
                                       {"count", &Of::count},
                                       {"d_nu_dx", &Of::d_nu_dx, &Known::gradients},
                                       {"d_v_x_dx", &Of::d_v_x_dx, &Known::gradients},
                                       {"d_v_z_dx", &Of::d_v_z_dx, &Known::gradients},
                                       {"d_sigma_zz_dx", &Of::d_sigma_zz_dx, &Known::gradients},
                                       {"d_sigma_xx_dx", &Of::d_sigma_xx_dx, &Known::gradients},
                                       {"d_sigma_xz_dx", &Of::d_sigma_xz_dx, &Known::gradients},
                                       {"d_k_dx", &Of::d_k_dx, &Known::gradients},
                                       {"d_sigma_zz_dz", &Of::d_sigma_zz_dz, &Known::gradients},
                                       {"d_sigma_xx_dz", &Of::d_sigma_xx_dz, &Known::gradients},
                                       {"d_sigma_xz_dz", &Of::d_sigma_xz_dz, &Known::gradients},
                                       {"nu_voronoi", &Of::nu_voronoi, &Known::cells},
                                       {"nu_grains", &Of::nu_grains, &Known::cells},
                                       {"sigma_xx_grains", &Of::sigma_xx_grains, &Known::cells},
                                       {"sigma_zz_grains", &Of::sigma_zz_grains, &Known::cells},
                                       {"sigma_xz_grains", &Of::sigma_xz_grains, &Known::cells}};

constexpr LayerQuantity of_rings[] = {{"v_t", &Of::v_x},
                                      {"v_r", &Of::v_z},
                                      {"shear_rate", &Of::shear_rate},
                                      {"half_vorticity", &Of::half_vorticity},
                                      {"omega", &Of::omega, &Known::spin},
                                      {"nu", &Of::nu},
                                      {"density", &Of::density, &Known::densities},
                                      {"sigma_rr_kinetic", &Of::sigma_zz_kinetic},
                                      {"sigma_rr", &Of::sigma_zz},
                                      {"sigma_tt_kinetic", &Of::sigma_xx_kinetic},
                                      {"sigma_tt", &Of::sigma_xx},
                                      {"sigma_rt_kinetic", &Of::sigma_xz_kinetic},
                                      {"sigma_rt", &Of::sigma_xz},
                                      {"I", &Of::I},
                                      {"mu", &Of::mu},
                                      {"k", &Of::k},
                                      {"count", &Of::count}};

constexpr LayerQuantity of_height[] = {{"v_x", &Of::v_x},
                                       {"v_z", &Of::v_z},
                                       {"omega", &Of::omega, &Known::spin},
                                       {"nu", &Of::nu},
                                       {"density", &Of::density, &Known::densities},
                                       {"sigma_zz_kinetic", &Of::sigma_zz_kinetic},
                                       {"sigma_xx_kinetic", &Of::sigma_xx_kinetic},
                                       {"sigma_xz_kinetic", &Of::sigma_xz_kinetic},
                                       {"sigma_zz", &Of::sigma_zz},
                                       {"sigma_xx", &Of::sigma_xx},
                                       {"sigma_xz", &Of::sigma_xz},
                                       {"k", &Of::k},
                                       {"count", &Of::count}};

constexpr LayerQuantity of_width[] = {{"v_x", &Of::v_z},
                                      {"v_z", &Of::v_x, nullptr, -1},
                                      {"d_v_z_dx", &Of::shear_rate, nullptr, -1},
                                      {"omega", &Of::omega, &Known::spin},
                                      {"nu", &Of::nu},
                                      {"density", &Of::density, &Known::densities},
                                      {"sigma_zz_kinetic", &Of::sigma_xx_kinetic},
                                      {"sigma_xx_kinetic", &Of::sigma_zz_kinetic},
                                      {"sigma_xz_kinetic", &Of::sigma_xz_kinetic, nullptr, -1},
                                      {"sigma_zz", &Of::sigma_xx},
                                      {"sigma_xx", &Of::sigma_zz},
                                      {"sigma_xz", &Of::sigma_xz, nullptr, -1},
                                      {"count", &Of::count}};

template <const auto& own>
std::span<const LayerQuantity> with_shared() {
  static constexpr auto all = [] {
    std::array<LayerQuantity, std::size(own) + std::size(shared_fields)> list{};
    auto next = std::copy(std::begin(own), std::end(own), list.begin());
    for (const auto& [name, value] : shared_fields) *next++ = {name, value};
    return list;
  }();
  return all;
}

/// Of a layer, summed over the snapshots.
double area_of(const LayerGrid& grid, const LayerSums& sums, std::size_t layer) {
  return grid.closed ? sums.snapshots.cell_area / static_cast<double>(grid.layers())
                     : grid.area[layer] * sums.snapshots.count;
}

double mean(double sum, double count) { return count > 0 ? sum / count : Of::none; }

/// Components of the spreads of a layer.
enum { of_v_x, of_v_z, of_x };

/// Slope of v_z over x within a layer: the other half of the vorticity.
double normal_velocity_slope(const Spread<4>& each) {
  const double spread = each.covariance(of_x, of_x);
  return each.weight > 2 && spread > 0 ? each.covariance(of_x, of_v_z) / spread : Of::none;
}

/// The gradient of a mean profile v_x(z) within a layer: otherwise shear would pass for fluctuation. A slope
/// that is not finite counts as 0.
Tensor<2> sheared(double slope) { return {{{0, std::isfinite(slope) ? slope : 0}, {0, 0}}}; }

/// Total stress = contact + kinetic. The rotational part stands beside them: momentum is balanced by the
/// motion of the centres, to which it does not belong. `slope`: of the mean v_x within the layer.
void set_stress(const LayerSum& sum, double area, double slope, bool with_contacts, LayerValues& f) {
  // Per unit of nu: grains of several densities count by their mass per area, about the velocity of their
  // centre of mass.
  const double density = f.nu * (sum.motion.weight / sum.grains);
  const Fields<2> fields = derive(sum, Background<2>{area, sheared(slope), density});
  f.sigma_xx_kinetic = fields.kinetic[0][0];
  f.sigma_zz_kinetic = fields.kinetic[1][1];
  // The traction of the upper layer on the lower one is against the flux of x momentum along +z. The shear
  // within the layer is not taken off here.
  if (sum.grains > 0) f.sigma_xz_kinetic = -density * sum.motion.covariance(of_v_x, of_v_z);
  f.sigma_rotational = sum.rotation / area;
  if (!with_contacts) return;
  f.sigma_xx = fields.contact[0][0] + f.sigma_xx_kinetic;
  f.sigma_zz = fields.contact[1][1] + f.sigma_zz_kinetic;
  f.sigma_xz = -fields.contact[0][1] + f.sigma_xz_kinetic;
  static_cast<SharedFields&>(f) = fields;
  const LayerRatios ratios = layer_ratios({f.sigma_xx, f.sigma_zz, f.sigma_xz}, f.shear_rate);
  f.I = ratios.I, f.mu = ratios.mu, f.k = ratios.k;
}

void set_fluctuations(const Spread<4>& each, LayerValues& f) {
  // The paper takes v_x(z) e_x off the velocity and nothing off its z component.
  if (each.weight > 1)
    f.dv = std::sqrt(fluctuation<2>(each, sheared(f.shear_rate), of_v_x, of_v_x) +
                     each.product(of_v_z, of_v_z) / each.weight);
}

void set_spins(const LayerSum& sum, LayerValues& f) {
  f.omega = mean(sum.spin, f.count);
  if (f.count > 1) f.domega = std::sqrt(std::max(0.0, sum.spin_spin / f.count - f.omega * f.omega));
}

void set_cells(const LayerSum::Cells& sum, LayerValues& f) {
  if (!(sum.grains > 0.5)) return;
  f.nu_voronoi = sum.discs / sum.cells;
  f.nu_grains = sum.nu / sum.grains;
  f.sigma_xx_grains = sum.stress_xx / sum.grains;
  f.sigma_zz_grains = sum.stress_zz / sum.grains;
  f.sigma_xz_grains = sum.stress_xz / sum.grains;
}

KnownQuantities known_of(const LayerSums::Snapshots& s) {
  return {s.spin == s.count, s.contacts == s.count, s.densities > 0, s.cells > 0, false};
}

void set_means(const LayerGrid& grid, const LayerSum& sum, double area, LayerValues& f) {
  f.count = sum.grains;
  f.v_x = grid.rings ? angular_velocity(sum.each, f.z) : sum.each.mean(of_v_x);
  f.v_z = sum.each.mean(of_v_z);
  f.nu = mean(sum.solid, area);
  f.density = mean(sum.solid_mass, area);
}

/// Returns the slope of v_x within the layer. In rings v_x has been the angular velocity until now.
double set_vorticity(const LayerGrid& grid, const LayerSum& sum, LayerValues& f) {
  f.half_vorticity =
      grid.rings ? f.v_x + f.shear_rate / 2 : (f.shear_rate - normal_velocity_slope(sum.each)) / 2;
  return slope_within(grid, f);
}

bool knows(const Profile& profile, const LayerQuantity& quantity) {
  return !quantity.needs || profile.known.*quantity.needs;
}

}  // namespace

std::span<const LayerQuantity> layer_quantities() { return with_shared<of_layers>(); }
std::span<const LayerQuantity> ring_quantities() { return with_shared<of_rings>(); }
std::span<const LayerQuantity> height_quantities() { return with_shared<of_height>(); }
std::span<const LayerQuantity> width_quantities() { return with_shared<of_width>(); }

double surface_height(const LayerGrid& grid, const LayerSums& sums, double surface_nu) {
  if (grid.closed) return grid.z_max();
  double above = 0;
  for (std::size_t l = grid.layers(); l-- > 0;) {
    const double here = mean(sums.layers[l].solid, area_of(grid, sums, l));
    if (here >= surface_nu) return grid.z_of(l) + grid.thickness * (here - surface_nu) / (here - above);
    if (!std::isnan(here)) above = here;
  }
  return Of::none;
}

Profile profile_of(const LayerGrid& grid, const LayerSums& sums, double surface_z) {
  std::size_t first = 0, end = grid.layers();
  while (first < end && !(grid.area[first] > 0)) ++first;
  while (!grid.closed && end > first && !(sums.layers[end - 1].solid > 0)) --end;
  Profile profile{std::vector<LayerValues>(end - first), known_of(sums.snapshots), surface_z};
  auto& layers = profile.layers;
  for (std::size_t l = 0; l < layers.size(); ++l) {
    const LayerSum& sum = sums.layers[first + l];
    layers[l].z = grid.z_of(first + l) - surface_z;
    set_means(grid, sum, area_of(grid, sums, first + l), layers[l]);
  }
  set_shear(grid, sums.snapshots.cell_jump / sums.snapshots.count, layers);
  for (std::size_t l = 0; l < layers.size(); ++l) {
    const LayerSum& sum = sums.layers[first + l];
    const double slope = set_vorticity(grid, sum, layers[l]);
    set_stress(sum, area_of(grid, sums, first + l), slope, profile.known.contacts, layers[l]);
    set_fluctuations(sum.each, layers[l]);
    set_cells(sum.cells, layers[l]);
    if (profile.known.spin) set_spins(sum, layers[l]);
  }
  return profile;
}

ProfileSet table_of(const Profile& profile, std::span<const LayerQuantity> quantities) {
  ProfileSet table;
  for (const LayerValues& layer : profile.layers) table.z.push_back(layer.z);
  for (const LayerQuantity& quantity : quantities) {
    if (!knows(profile, quantity)) continue;
    ProfileColumn& column = table.columns.emplace_back(ProfileColumn{quantity.name, {}, {}});
    for (const LayerValues& layer : profile.layers)
      column.value.push_back(quantity.sign * layer.*quantity.value);
  }
  return table;
}

ProfileSet table_of(const LeaveOneOut<Profile>& profiles, std::span<const LayerQuantity> quantities) {
  ProfileSet table = table_of(profiles.whole, quantities);
  auto column = table.columns.begin();
  for (const LayerQuantity& quantity : quantities) {
    if (!knows(profiles.whole, quantity)) continue;
    for (std::size_t l = 0; l < table.z.size() && quantity.value != &LayerValues::count; ++l)
      column->ci99.push_back(ci99_of(profiles, [&](const Profile& one) {
        return l < one.layers.size() ? one.layers[l].*quantity.value : Of::none;
      }));
    ++column;
  }
  return table;
}

}  // namespace drumlin::particles
