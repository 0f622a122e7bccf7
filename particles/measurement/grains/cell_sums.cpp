#include "particles/measurement/grains/cell_sums.hpp"

#include <vector>

#include "coupling/core/basics/no_value.hpp"
#include "particles/measurement/frame/grain_bins.hpp"

namespace drumlin::particles {

void add_cells(const LayerGrid& of_all, const Snapshot& snapshot, const FlowSnapshot& in_frame,
               LayerSums& sums) {
  const LayerGrid grid = of_all.in_cell(in_frame);
  const std::vector<GrainSum> grains = sums_of_grains(in_frame);
  const double known = in_frame.contacts_known ? 1 : no_value;
  VoronoiTessellation tessellation(snapshot);
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const std::size_t layer = grid.layer_of(in_frame.x[i], in_frame.z[i]);
    if (layer >= grid.layers()) continue;
    const double area = tessellation.cell(i).area;
    if (!(area > 0)) continue;
    const Fields<2> fields = derive(grains[i], Background<2>{area});
    LayerSum::Cells& sum = sums.layers[layer].cells;
    sum.grains += 1;
    sum.discs += grains[i].solid;
    sum.cells += area;
    sum.nu += fields.nu;
    sum.stress_xx += known * fields.contact[0][0];
    sum.stress_zz += known * fields.contact[1][1];
    sum.stress_xz -= known * fields.contact[0][1];
  }
  sums.snapshots.cells += 1;
}

}  // namespace drumlin::particles
