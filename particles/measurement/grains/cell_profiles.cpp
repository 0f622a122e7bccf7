#include "particles/measurement/grains/cell_profiles.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace drumlin::particles {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

template <class Action>
void for_each_sum(CellLayerSum& a, const CellLayerSum& b, Action action) {
  for (auto member : {&CellLayerSum::grains, &CellLayerSum::discs, &CellLayerSum::cells, &CellLayerSum::nu,
                      &CellLayerSum::stress_xx, &CellLayerSum::stress_zz, &CellLayerSum::stress_xz})
    action(a.*member, b.*member);
}

void add_columns(const LayerGrid& grid, double surface_z, const std::vector<CellLayerSum>& sums,
                 ProfileSet& profiles) {
  const auto add = [&](const char* name, double CellLayerSum::*sum, double CellLayerSum::*over) {
    std::vector<double> values;
    for (const double z : profiles.z) {
      // Profiles leave out the layers at the ends that hold nothing.
      const double layer = std::round((z + surface_z - grid.z_min) / grid.thickness - 0.5);
      const CellLayerSum& here = sums[static_cast<std::size_t>(layer)];
      values.push_back(here.grains > 0.5 ? here.*sum / here.*over : none);
    }
    profiles.columns.push_back({name, std::move(values), {}});
  };
  add("nu_voronoi", &CellLayerSum::discs, &CellLayerSum::cells);
  add("nu_grains", &CellLayerSum::nu, &CellLayerSum::grains);
  add("sigma_xx_grains", &CellLayerSum::stress_xx, &CellLayerSum::grains);
  add("sigma_zz_grains", &CellLayerSum::stress_zz, &CellLayerSum::grains);
  add("sigma_xz_grains", &CellLayerSum::stress_xz, &CellLayerSum::grains);
}

}  // namespace

CellSlice empty_cell_slice(const Slice& slice, const VoronoiOptions& options) {
  CellSlice cells;
  cells.options = options;
  cells.batches.assign(slice.batches.size(), std::vector<CellLayerSum>(slice.grid.layers()));
  return cells;
}

void add_snapshot(const Slice& slice, const Snapshot& snapshot, const FlowSnapshot& in_frame,
                  std::size_t batch, CellSlice& cells) {
  const LayerGrid grid = slice.grid.closed ? slice.grid.in_cell(*in_frame.cell) : slice.grid;
  std::vector<CellLayerSum>& sums = cells.batches[batch];
  VoronoiTessellation tessellation(snapshot, cells.options);
  cells.area.assign(in_frame.x.size(), none);
  cells.layer.assign(in_frame.x.size(), -1);
  for (std::size_t i = 0; i < in_frame.x.size(); ++i) {
    const std::size_t layer = grid.layer_at(in_frame.z[i]);
    if (in_frame.x[i] < grid.x_min || in_frame.x[i] > grid.x_max || layer >= sums.size()) continue;
    const double area = tessellation.cell(i).area;
    if (!(area > 0)) continue;
    const double disc = std::numbers::pi * in_frame.radius[i] * in_frame.radius[i];
    cells.area[i] = area;
    cells.layer[i] = static_cast<std::int32_t>(layer);
    CellLayerSum& sum = sums[layer];
    sum.grains += 1;
    sum.discs += disc;
    sum.cells += area;
    sum.nu += disc / area;
  }
  if (!in_frame.contacts_known)
    for (CellLayerSum& sum : sums) sum.stress_xx = sum.stress_zz = sum.stress_xz = none;
  for (const HalfBranch& half : in_frame.half_branches()) {
    if (cells.layer[half.grain] < 0) continue;
    CellLayerSum& sum = sums[static_cast<std::size_t>(cells.layer[half.grain])];
    const double area = cells.area[half.grain];
    sum.stress_xx -= half.force_x * half.toward_x / area;
    sum.stress_zz -= half.force_z * half.toward_z / area;
    sum.stress_xz += half.force_x * half.toward_z / area;
  }
}

void add_cell_columns(const Slice& slice, const CellSlice& cells, SliceProfiles& measured) {
  std::vector<CellLayerSum> total(slice.grid.layers());
  for (const auto& batch : cells.batches)
    for (std::size_t l = 0; l < total.size(); ++l)
      for_each_sum(total[l], batch[l], [](double& a, double b) { a += b; });
  add_columns(slice.grid, measured.surface_z, total, measured.profiles);
  for (std::size_t b = 0; b < measured.leave_one_out.size(); ++b) {
    std::vector<CellLayerSum> rest = total;
    for (std::size_t l = 0; l < rest.size(); ++l)
      for_each_sum(rest[l], cells.batches[b][l], [](double& a, double c) { a -= c; });
    add_columns(slice.grid, measured.leave_one_out_surface_z[b], rest, measured.leave_one_out[b]);
  }
}

}  // namespace drumlin::particles
