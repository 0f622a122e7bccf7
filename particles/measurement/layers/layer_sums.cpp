#include "particles/measurement/layers/layer_sums.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace drumlin::particles {
namespace {

/// Every sum in turn, so that none is forgotten when batches are added or taken apart.
template <class Action>
void for_each_sum(LayerSum& a, const LayerSum& b, Action action) {
  for (auto member : {&LayerSum::covered,
                      &LayerSum::grains,
                      &LayerSum::x,
                      &LayerSum::zeta,
                      &LayerSum::v_x,
                      &LayerSum::v_z,
                      &LayerSum::spin,
                      &LayerSum::x_x,
                      &LayerSum::zeta_zeta,
                      &LayerSum::zeta_v_x,
                      &LayerSum::x_v_z,
                      &LayerSum::v_x_v_x,
                      &LayerSum::v_z_v_z,
                      &LayerSum::v_x_v_z,
                      &LayerSum::spin_spin,
                      &LayerSum::force_x_branch_x,
                      &LayerSum::force_x_branch_z,
                      &LayerSum::force_z_branch_x,
                      &LayerSum::force_z_branch_z,
                      &LayerSum::contacts,
                      &LayerSum::rotation,
                      &LayerSum::covered_mass,
                      &LayerSum::density,
                      &LayerSum::dense_zeta,
                      &LayerSum::dense_v_x,
                      &LayerSum::dense_v_z,
                      &LayerSum::dense_zeta_zeta,
                      &LayerSum::dense_zeta_v_x,
                      &LayerSum::dense_v_x_v_x,
                      &LayerSum::dense_v_z_v_z,
                      &LayerSum::dense_v_x_v_z})
    action(a.*member, b.*member);
}

/// Of a layer that a grid has, or in a closed one that is an image of it.
std::size_t index_in(const LayerGrid& grid, double layer) {
  const auto count = static_cast<double>(grid.layers());
  return static_cast<std::size_t>(grid.closed ? layer - count * std::floor(layer / count) : layer);
}

/// Adds the area of a disc that reaches into the slice to its layers, and its mass where it has a density.
template <class Add>
void share_covered_area(const LayerGrid& grid, double x, double z, double radius,
                        std::vector<LayerSum>& layers, Add add) {
  double first = std::floor((z - radius - grid.z_min) / grid.thickness);
  double end = std::ceil((z + radius - grid.z_min) / grid.thickness);
  if (!grid.closed) first = std::max(0.0, first), end = std::min(static_cast<double>(layers.size()), end);
  if (x - radius < grid.x_min || x + radius > grid.x_max) {
    for (double layer = first; layer < end; ++layer) {
      const auto index = static_cast<std::size_t>(layer);
      add(layers[index], disc_area_in(x, z, radius, grid.rectangle(index)));
    }
    return;
  }
  // Between the sides of the slice layers cut the disc into strips: one evaluation a boundary.
  double below = disc_area_left_of(radius, grid.z_min + first * grid.thickness - z);
  for (double layer = first; layer < end; ++layer) {
    const double up_to = disc_area_left_of(radius, grid.z_min + (layer + 1) * grid.thickness - z);
    add(layers[index_in(grid, layer)], up_to - below);
    below = up_to;
  }
}

/// What the kinetic stress of grains of several densities needs.
void add_dense_moments(double density, double zeta, double v_x, double v_z, LayerSum& sum) {
  sum.density += density;
  sum.dense_zeta += density * zeta;
  sum.dense_v_x += density * v_x;
  sum.dense_v_z += density * v_z;
  sum.dense_zeta_zeta += density * zeta * zeta;
  sum.dense_zeta_v_x += density * zeta * v_x;
  sum.dense_v_x_v_x += density * v_x * v_x;
  sum.dense_v_z_v_z += density * v_z * v_z;
  sum.dense_v_x_v_z += density * v_x * v_z;
}

void add_grain(const LayerGrid& grid, const FlowSnapshot& snapshot, std::size_t i,
               std::vector<LayerSum>& layers) {
  const double x = snapshot.x[i], z = snapshot.z[i], radius = snapshot.radius[i];
  if (x + radius <= grid.x_min || x - radius >= grid.x_max) return;
  const bool dense = !snapshot.density.empty();
  const double density = dense ? snapshot.density[i] : 1;
  if (dense)
    share_covered_area(grid, x, z, radius, layers, [density](LayerSum& sum, double area) {
      sum.covered += area;
      sum.covered_mass += density * area;
    });
  else
    share_covered_area(grid, x, z, radius, layers, [](LayerSum& sum, double area) { sum.covered += area; });
  const std::size_t index = grid.layer_at(z);
  if (x < grid.x_min || x > grid.x_max || index >= layers.size()) return;

  add_centre({x, z - grid.z_of(index), snapshot.v_x[i], snapshot.v_z[i]}, snapshot, i, layers[index]);
}

/// Shares a half branch out among the layers in proportion to its length in each, cut at the sides of the
/// slice.
void add_half_branch(const LayerGrid& grid, const HalfBranch& branch, std::vector<LayerSum>& layers) {
  if (std::min(branch.x, branch.x + branch.toward_x) > grid.x_max ||
      std::max(branch.x, branch.x + branch.toward_x) < grid.x_min)
    return;
  double begin = 0, end = 1;  // parameter along the branch
  if (branch.toward_x != 0) {
    const double west = (grid.x_min - branch.x) / branch.toward_x,
                 east = (grid.x_max - branch.x) / branch.toward_x;
    begin = std::max(begin, std::min(west, east));
    end = std::min(end, std::max(west, east));
  } else if (branch.x < grid.x_min || branch.x > grid.x_max) {
    return;
  }
  if (!(begin < end)) return;

  const double low = branch.z + (branch.toward_z > 0 ? begin : end) * branch.toward_z;
  const double high = branch.z + (branch.toward_z > 0 ? end : begin) * branch.toward_z;
  double first = std::floor((low - grid.z_min) / grid.thickness);
  double last = std::floor((high - grid.z_min) / grid.thickness);
  if (!grid.closed)
    first = std::max(0.0, first), last = std::min(static_cast<double>(layers.size()) - 1, last);
  for (double layer = first; layer <= last; ++layer) {
    double share = end - begin;
    if (first < last || low < grid.z_min + first * grid.thickness ||
        high > grid.z_min + (last + 1) * grid.thickness) {
      const double bottom = grid.z_min + layer * grid.thickness;
      const double inside = std::min(high, bottom + grid.thickness) - std::max(low, bottom);
      share = std::max(0.0, inside) / std::abs(branch.toward_z);
    }
    LayerSum& sum = layers[index_in(grid, layer)];
    // b points from the contact to the centre: against `toward`.
    sum.force_x_branch_x -= branch.force_x * branch.toward_x * share;
    sum.force_x_branch_z -= branch.force_x * branch.toward_z * share;
    sum.force_z_branch_x -= branch.force_z * branch.toward_x * share;
    sum.force_z_branch_z -= branch.force_z * branch.toward_z * share;
  }
}

}  // namespace

void add_centre(const CentreInLayer& centre, const FlowSnapshot& snapshot, std::size_t i, LayerSum& sum) {
  const auto [x, zeta, v_x, v_z] = centre;
  const bool dense = !snapshot.density.empty();
  const double density = dense ? snapshot.density[i] : 1;
  sum.grains += 1;
  sum.x += x;
  sum.zeta += zeta;
  sum.v_x += v_x;
  sum.v_z += v_z;
  sum.x_x += x * x;
  sum.zeta_zeta += zeta * zeta;
  sum.zeta_v_x += zeta * v_x;
  sum.x_v_z += x * v_z;
  sum.v_x_v_x += v_x * v_x;
  sum.v_z_v_z += v_z * v_z;
  sum.v_x_v_z += v_x * v_z;
  sum.contacts += snapshot.coordination[i];
  if (dense) add_dense_moments(density, zeta, v_x, v_z, sum);
  if (snapshot.spin.empty()) return;
  const double spin = snapshot.spin[i];
  sum.spin += spin;
  sum.spin_spin += spin * spin;
  const double energy = std::numbers::pi / 4 * std::pow(snapshot.radius[i], 4) * spin * spin;
  sum.rotation += dense ? density * energy : energy;
}

LayerSum& LayerSum::operator+=(const LayerSum& other) {
  for_each_sum(*this, other, [](double& a, double b) { a += b; });
  return *this;
}

LayerSum& LayerSum::operator-=(const LayerSum& other) {
  for_each_sum(*this, other, [](double& a, double b) { a -= b; });
  return *this;
}

LayerSums& LayerSums::operator+=(const LayerSums& other) {
  for (std::size_t l = 0; l < layers.size(); ++l) layers[l] += other.layers[l];
  snapshots += other.snapshots;
  cell_area += other.cell_area;
  cell_jump += other.cell_jump;
  return *this;
}

LayerSums& LayerSums::operator-=(const LayerSums& other) {
  for (std::size_t l = 0; l < layers.size(); ++l) layers[l] -= other.layers[l];
  snapshots -= other.snapshots;
  cell_area -= other.cell_area;
  cell_jump -= other.cell_jump;
  return *this;
}

Rectangle LayerGrid::rectangle(std::size_t layer) const {
  const double bottom = z_min + static_cast<double>(layer) * thickness;
  return Rectangle{x_min, x_max, bottom, bottom + thickness};
}

std::size_t LayerGrid::layer_at(double z) const {
  const double place = std::floor((z - z_min) / thickness), count = static_cast<double>(layers());
  if (closed) return static_cast<std::size_t>(std::clamp(place, 0.0, count - 1));
  return place >= 0 && place < count ? static_cast<std::size_t>(place) : layers();
}

LayerGrid LayerGrid::in_cell(const FlowCell& cell) const {
  LayerGrid grid = *this;
  grid.z_min = cell.z_min;
  grid.thickness = cell.height / static_cast<double>(layers());
  return grid;
}

LayerGrid closed_grid(const FlowFrame& frame, double thickness, double z_from, double z_to, double period) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double layers = std::max(1.0, std::round((z_to - z_from) / thickness));
  LayerGrid grid{frame, -infinity, infinity, z_from, (z_to - z_from) / layers, {}, true};
  grid.area.assign(static_cast<std::size_t>(layers), period * grid.thickness);
  return grid;
}

LayerGrid layer_grid(const FlowFrame& frame, double position, double slice_width, double thickness,
                     double z_from, double z_to, double container_radius, double period) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  LayerGrid grid{frame, position - slice_width / 2, position + slice_width / 2, 0, thickness, {}, false};
  if (period > 0) {
    grid.x_min = -infinity;
    grid.x_max = infinity;
  }
  const double first = std::floor(z_from / thickness), end = std::ceil(z_to / thickness);
  grid.z_min = first * thickness;
  grid.area.assign(static_cast<std::size_t>(std::max(0.0, end - first)),
                   (period > 0 ? period : slice_width) * thickness);
  if (container_radius > 0)
    for (std::size_t l = 0; l < grid.layers(); ++l)
      grid.area[l] = disc_area_in(0, 0, container_radius, grid.rectangle(l));
  return grid;
}

void add_snapshot(const LayerGrid& of_all, const FlowSnapshot& snapshot, LayerSums& sums) {
  std::optional<LayerGrid> of_cell;
  if (of_all.closed) {
    of_cell = of_all.in_cell(*snapshot.cell);
    sums.cell_area += snapshot.cell->length * snapshot.cell->height;
    sums.cell_jump += snapshot.cell->v_x;
  }
  const LayerGrid& grid = of_cell ? *of_cell : of_all;
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) add_grain(grid, snapshot, i, sums.layers);
  for (const HalfBranch& branch : snapshot.half_branches()) add_half_branch(grid, branch, sums.layers);
  sums.with_spin = sums.with_spin && !snapshot.spin.empty();
  sums.with_densities = sums.with_densities || !snapshot.density.empty();
  sums.with_contacts = sums.with_contacts && snapshot.contacts_known;
  ++sums.snapshots;
}

}  // namespace drumlin::particles
