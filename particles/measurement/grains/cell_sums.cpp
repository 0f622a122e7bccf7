#include "particles/measurement/grains/cell_sums.hpp"

#include <limits>
#include <numbers>
#include <vector>

namespace drumlin::particles {

void add_cells(const LayerGrid& of_all, const Snapshot& snapshot, const FlowSnapshot& in_frame,
               LayerSums& sums) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const LayerGrid grid = of_all.in_cell(in_frame);
  VoronoiTessellation tessellation(snapshot);
  std::vector<double> areas(in_frame.x.size(), none);
  std::vector<LayerSum::Cells*> layer_of(in_frame.x.size(), nullptr);
  for (std::size_t i = 0; i < in_frame.x.size(); ++i) {
    const std::size_t layer = grid.layer_at(in_frame.z[i]);
    if (in_frame.x[i] < grid.x_min || in_frame.x[i] > grid.x_max || layer >= grid.layers()) continue;
    const double area = tessellation.cell(i).area;
    if (!(area > 0)) continue;
    const double disc = std::numbers::pi * in_frame.radius[i] * in_frame.radius[i];
    LayerSum::Cells& sum = sums.layers[layer].cells;
    areas[i] = area;
    layer_of[i] = &sum;
    sum.grains += 1;
    sum.discs += disc;
    sum.cells += area;
    sum.nu += disc / area;
  }
  sums.snapshots.cells += 1;
  if (!in_frame.contacts_known)
    for (LayerSum& sum : sums.layers) sum.cells.stress_xx = sum.cells.stress_zz = sum.cells.stress_xz = none;
  for (const HalfBranch<2>& half : in_frame.half_branches()) {
    if (layer_of[half.grain] == nullptr) continue;
    LayerSum::Cells& sum = *layer_of[half.grain];
    const double area = areas[half.grain];
    sum.stress_xx -= half.force[0] * half.toward[0] / area;
    sum.stress_zz -= half.force[1] * half.toward[1] / area;
    sum.stress_xz += half.force[0] * half.toward[1] / area;
  }
}

}  // namespace drumlin::particles
