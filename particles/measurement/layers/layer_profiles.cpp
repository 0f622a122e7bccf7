#include "particles/measurement/layers/layer_profiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "particles/measurement/layers/velocity_moments.hpp"

namespace drumlin::particles {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Of a layer, summed over the snapshots.
double area_of(const LayerGrid& grid, const LayerSums& sums, std::size_t layer) {
  return grid.closed ? sums.cell_area / static_cast<double>(grid.layers())
                     : grid.area[layer] * static_cast<double>(sums.snapshots);
}

double volume_fraction(const LayerGrid& grid, const LayerSums& sums, std::size_t layer) {
  const double area = area_of(grid, sums, layer);
  return area > 0 ? sums.layers[layer].covered / area : none;
}

double mean(double sum, double count) { return count > 0 ? sum / count : none; }

/// (v[l + 1] - v[l - 1]) / (2 thickness); NaN beside an empty layer, and at the ends of an open grid. Beyond
/// those of a cell follow images, which move with it.
std::vector<double> shear_rates(const std::vector<double>& v_x, const LayerGrid& grid,
                                const LayerSums& sums) {
  std::vector<double> slope(v_x.size(), none);
  for (std::size_t l = 1; l + 1 < v_x.size(); ++l)
    slope[l] = (v_x[l + 1] - v_x[l - 1]) / (2 * grid.thickness);
  if (grid.closed && v_x.size() > 1) {
    const double jump = sums.cell_jump / static_cast<double>(sums.snapshots);
    slope.front() = (v_x[1] - (v_x.back() - jump)) / (2 * grid.thickness);
    slope.back() = (v_x.front() + jump - v_x[v_x.size() - 2]) / (2 * grid.thickness);
  }
  return slope;
}

/// Slope of v_z over x within a layer: the other half of the vorticity.
double normal_velocity_slope(const LayerSum& sum) {
  const double spread = covariance(sum.x_x, sum.x, sum.x, sum.grains);
  return sum.grains > 2 && spread > 0 ? covariance(sum.x_v_z, sum.x, sum.v_z, sum.grains) / spread : none;
}

/// The columns being made, over the layers first ... first + layers - 1 of the grid.
struct Columns {
  const LayerGrid& grid;
  const LayerSums& sums;
  std::size_t first, layers;
  ProfileSet profiles;

  const std::vector<double>& of(const std::string& name) const { return profiles.column(name).value; }
  /// Adds a column with value(l, sum of layer l).
  template <class Value>
  void add(const std::string& name, Value value) {
    std::vector<double> values(layers);
    for (std::size_t l = 0; l < layers; ++l) values[l] = value(l, sums.layers[first + l]);
    profiles.columns.push_back({name, std::move(values), {}});
  }
};

void add_kinematics(Columns& columns) {
  columns.add("v_x", [](std::size_t, const LayerSum& sum) { return mean(sum.v_x, sum.grains); });
  columns.add("v_z", [](std::size_t, const LayerSum& sum) { return mean(sum.v_z, sum.grains); });
  const auto rate = shear_rates(columns.of("v_x"), columns.grid, columns.sums);
  columns.add("shear_rate", [&](std::size_t l, const LayerSum&) { return rate[l]; });
  columns.add("half_vorticity",
              [&](std::size_t l, const LayerSum& sum) { return (rate[l] - normal_velocity_slope(sum)) / 2; });
  if (columns.sums.with_spin)
    columns.add("omega", [](std::size_t, const LayerSum& sum) { return mean(sum.spin, sum.grains); });
  columns.add("nu", [&](std::size_t l, const LayerSum&) {
    return volume_fraction(columns.grid, columns.sums, columns.first + l);
  });
  if (!columns.sums.with_densities) return;
  columns.add("density", [&](std::size_t l, const LayerSum& sum) {
    const double area = area_of(columns.grid, columns.sums, columns.first + l);
    return area > 0 ? sum.covered_mass / area : none;
  });
}

/// Total stress = contact + kinetic. The rotational part stands beside them: momentum is balanced by the
/// motion of the centres, to which it does not belong.
void add_stresses(Columns& columns) {
  const auto rate = columns.of("shear_rate");
  const auto nu = columns.of("nu");
  const auto kinetic = [&](double VelocityMoments::*moment) {
    return [&rate, &nu, moment](std::size_t l, const LayerSum& sum) {
      return sum.grains > 0 ? nu[l] * stress_moments(sum, rate[l]).*moment : 0.0;
    };
  };
  columns.add("sigma_xx_kinetic", kinetic(&VelocityMoments::xx));
  columns.add("sigma_zz_kinetic", kinetic(&VelocityMoments::zz));
  // The traction of the upper layer on the lower one is against the flux of x momentum along +z.
  columns.add("sigma_xz_kinetic",
              [&](std::size_t l, const LayerSum& sum) { return -kinetic(&VelocityMoments::xz)(l, sum); });
  const auto total = [&](const std::string& name, double sign, double LayerSum::*contact) {
    const auto kinetic_part = columns.of(name + "_kinetic");
    columns.add(name, [&](std::size_t l, const LayerSum& sum) {
      const double area = area_of(columns.grid, columns.sums, columns.first + l);
      return columns.sums.with_contacts ? sign * sum.*contact / area + kinetic_part[l] : none;
    });
  };
  if (columns.sums.with_spin)
    columns.add("sigma_rotational", [&](std::size_t l, const LayerSum& sum) {
      return sum.rotation / area_of(columns.grid, columns.sums, columns.first + l);
    });
  total("sigma_xx", 1, &LayerSum::force_x_branch_x);
  total("sigma_zz", 1, &LayerSum::force_z_branch_z);
  total("sigma_xz", -1, &LayerSum::force_x_branch_z);
}

void add_ratios(Columns& columns) {
  const auto rate = columns.of("shear_rate"), xx = columns.of("sigma_xx"), zz = columns.of("sigma_zz"),
             xz = columns.of("sigma_xz");
  const auto under_load = [&](std::size_t l, double value) { return zz[l] > 0 ? value : none; };
  columns.add("I", [&](std::size_t l, const LayerSum&) { return under_load(l, rate[l] / std::sqrt(zz[l])); });
  // Not tau:D/(2 |D| p), the mu of a law: in a creeping bed their axes differ (docs/theory/measurement.md).
  columns.add("mu", [&](std::size_t l, const LayerSum&) { return under_load(l, xz[l] / zz[l]); });
  columns.add("k", [&](std::size_t l, const LayerSum&) { return under_load(l, xx[l] / zz[l]); });
}

void add_fluctuations(Columns& columns) {
  const auto rate = columns.of("shear_rate");
  // The paper takes v_x(z) e_x off the velocity and nothing off its z component.
  columns.add("dv", [&](std::size_t l, const LayerSum& sum) {
    return sum.grains > 1 ? std::sqrt(velocity_moments(sum, rate[l]).xx + sum.v_z_v_z / sum.grains) : none;
  });
  if (!columns.sums.with_spin) return;
  columns.add("domega", [](std::size_t, const LayerSum& sum) {
    return sum.grains > 1
               ? std::sqrt(std::max(0.0, covariance(sum.spin_spin, sum.spin, sum.spin, sum.grains)))
               : none;
  });
}

}  // namespace

double surface_height(const LayerGrid& grid, const LayerSums& sums, double surface_nu) {
  if (grid.closed) return grid.z_max();
  double above = 0;
  for (std::size_t l = grid.layers(); l-- > 0;) {
    const double here = volume_fraction(grid, sums, l);
    if (here >= surface_nu) return grid.z_of(l) + grid.thickness * (here - surface_nu) / (here - above);
    if (!std::isnan(here)) above = here;
  }
  return none;
}

ProfileSet layer_profiles(const LayerGrid& grid, const LayerSums& sums, double surface_z) {
  std::size_t first = 0, end = grid.layers();
  while (first < end && !(grid.area[first] > 0)) ++first;
  while (!grid.closed && end > first && !(sums.layers[end - 1].covered > 0)) --end;
  Columns columns{grid, sums, first, end - first, {}};
  for (std::size_t l = first; l < end; ++l) columns.profiles.z.push_back(grid.z_of(l) - surface_z);
  add_kinematics(columns);
  add_stresses(columns);
  add_ratios(columns);
  add_fluctuations(columns);
  columns.add("coordination", [&](std::size_t, const LayerSum& sum) {
    return columns.sums.with_contacts ? mean(sum.contacts, sum.grains) : none;
  });
  columns.add("count", [](std::size_t, const LayerSum& sum) { return sum.grains; });
  return std::move(columns.profiles);
}

}  // namespace drumlin::particles
