#include "particles/measurement/layers/layer_sums.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Of a layer that a grid has, or in a closed one that is an image of it.
std::size_t index_in(const LayerGrid& grid, double layer) {
  const auto count = static_cast<double>(grid.layers());
  return static_cast<std::size_t>(grid.closed ? layer - count * std::floor(layer / count) : layer);
}

/// Layers that a stretch of heights touches.
struct Reach {
  double first, last;
};
Reach layers_between(const LayerGrid& grid, double first, double last) {
  if (grid.closed) return {first, last};
  return {std::max(0.0, first), std::min(static_cast<double>(grid.layers()) - 1, last)};
}

/// Adds the area of a disc that reaches into the slice to its layers.
void add_disc(const LayerGrid& grid, double x, double z, double radius, double density,
              std::vector<LayerSum>& layers) {
  const auto [first, last] = layers_between(grid, std::floor((z - radius - grid.z_min) / grid.thickness),
                                            std::ceil((z + radius - grid.z_min) / grid.thickness) - 1);
  const bool cut = x - radius < grid.x_min || x + radius > grid.x_max;
  // Between the sides of the slice layers cut the disc into strips: one evaluation a boundary.
  const auto below = [&](double layer) {
    return disc_area_left_of(radius, grid.z_min + layer * grid.thickness - z);
  };
  double before = cut ? 0 : below(first);
  for (double layer = first; layer <= last; ++layer) {
    LayerSum& sum = layers[index_in(grid, layer)];
    const double up_to = cut ? 0 : below(layer + 1);
    const double area =
        cut ? disc_area_in(x, z, radius, grid.rectangle(static_cast<std::size_t>(layer))) : up_to - before;
    before = up_to;
    sum.covered += area;
    sum.covered_mass += density * area;
  }
}

void add_grain(const LayerGrid& grid, const FlowSnapshot& snapshot, std::size_t i,
               std::vector<LayerSum>& layers) {
  const double x = snapshot.x[i], z = snapshot.z[i], radius = snapshot.radius[i];
  if (x + radius <= grid.x_min || x - radius >= grid.x_max) return;
  add_disc(grid, x, z, radius, snapshot.density_of(i), layers);
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
  const auto [first, last] = layers_between(grid, std::floor((low - grid.z_min) / grid.thickness),
                                            std::floor((high - grid.z_min) / grid.thickness));
  for (double layer = first; layer <= last; ++layer) {
    double share = end - begin;
    if (first < last || low < grid.z_min + first * grid.thickness ||
        high > grid.z_min + (last + 1) * grid.thickness) {
      const double bottom = grid.z_min + layer * grid.thickness;
      const double inside = std::min(high, bottom + grid.thickness) - std::max(low, bottom);
      share = std::max(0.0, inside) / std::abs(branch.toward_z);
    }
    // b points from the contact to the centre: against `toward`.
    PlaneMatrix& sum = layers[index_in(grid, layer)].force_branch;
    sum.xx -= branch.force_x * branch.toward_x * share;
    sum.xz -= branch.force_x * branch.toward_z * share;
    sum.zx -= branch.force_z * branch.toward_x * share;
    sum.zz -= branch.force_z * branch.toward_z * share;
  }
}

void add_moments(double weight, const CentreInLayer& centre, Moments& sum) {
  const auto [x, zeta, v_x, v_z] = centre;
  sum.weight += weight;
  sum.zeta += weight * zeta;
  sum.v_x += weight * v_x;
  sum.v_z += weight * v_z;
  sum.zeta_zeta += weight * zeta * zeta;
  sum.zeta_v_x += weight * zeta * v_x;
  sum.v_x_v_x += weight * v_x * v_x;
  sum.v_z_v_z += weight * v_z * v_z;
  sum.v_x_v_z += weight * v_x * v_z;
}

}  // namespace

void add_centre(const CentreInLayer& centre, const FlowSnapshot& snapshot, std::size_t i, LayerSum& sum) {
  const double density = snapshot.density_of(i), spin = snapshot.spin.empty() ? 0 : snapshot.spin[i];
  add_moments(1, centre, sum.grains);
  add_moments(density, centre, sum.mass);
  sum.x += centre.x;
  sum.x_x += centre.x * centre.x;
  sum.x_v_z += centre.x * centre.v_z;
  sum.contacts += snapshot.coordination[i];
  sum.spin += spin;
  sum.spin_spin += spin * spin;
  sum.rotation += density * (std::numbers::pi / 4 * std::pow(snapshot.radius[i], 4) * spin * spin);
}

void add_times(double factor, const LayerSums& from, LayerSums& to) {
  for (std::size_t l = 0; l < to.layers.size(); ++l) add_times(factor, from.layers[l], to.layers[l]);
  add_times(factor, from.snapshots, to.snapshots);
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
  const double layers = std::max(1.0, std::round((z_to - z_from) / thickness));
  LayerGrid grid{frame, -infinity, infinity, z_from, (z_to - z_from) / layers, {}, true};
  grid.area.assign(static_cast<std::size_t>(layers), period * grid.thickness);
  return grid;
}

LayerGrid layer_grid(const FlowFrame& frame, double position, double slice_width, double thickness,
                     double z_from, double z_to, double container_radius, double period) {
  LayerGrid grid{frame, position - slice_width / 2, position + slice_width / 2, 0, thickness, {}};
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
  LayerSums::Snapshots& known = sums.snapshots;
  known.count += 1;
  known.spin += snapshot.spin.empty() ? 0 : 1;
  known.contacts += snapshot.contacts_known ? 1 : 0;
  known.densities += snapshot.density.empty() ? 0 : 1;
  if (of_all.rings) return add_to_rings(of_all, snapshot, sums.layers);
  if (of_all.closed) {
    known.cell_area += snapshot.cell->length * snapshot.cell->height;
    known.cell_jump += snapshot.cell->v_x;
  }
  const LayerGrid grid = of_all.closed ? of_all.in_cell(*snapshot.cell) : of_all;
  for (std::size_t i = 0; i < snapshot.x.size(); ++i) add_grain(grid, snapshot, i, sums.layers);
  for (const HalfBranch& branch : snapshot.half_branches()) add_half_branch(grid, branch, sums.layers);
}

}  // namespace drumlin::particles
