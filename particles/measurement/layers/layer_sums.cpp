#include "particles/measurement/layers/layer_sums.hpp"

#include "particles/measurement/frame/accumulate.hpp"
#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {

void LayerSum::add_centre(double weight, const GrainSample<2>& grain) {
  Moments::add_centre(weight, grain);
  const std::array motion_and_place{grain.velocity[0], grain.velocity[1], grain.at[0], grain.at[1]};
  each.add(weight, motion_and_place);
  motion.add(weight * grain.density, motion_and_place);
  spin_spin += weight * grain.spin * grain.spin;
  rotation += weight * grain.spin_energy();
}

void add_times(double factor, const LayerSums& from, LayerSums& to) {
  for (std::size_t l = 0; l < to.layers.size(); ++l) add_times(factor, from.layers[l], to.layers[l]);
  add_times(factor, from.snapshots, to.snapshots);
}

void add_snapshot(const LayerGrid& grid, const FlowSnapshot& snapshot, LayerSums& sums) {
  LayerSums::Snapshots& known = sums.snapshots;
  known.add(snapshot);
  if (grid.rings) return accumulate(snapshot, RingBinning(grid), sums.layers);
  if (grid.closed) {
    const Period& cell = snapshot.cell;
    known.cell_area += cell.length * cell.length_z;
    known.cell_jump += cell.image_velocity({cell.offset, cell.length_z}).x;
  }
  const LayerGrid here = grid.in_cell(snapshot);
  accumulate(snapshot, LayerBinning(here), sums.layers);
}

}  // namespace drumlin::particles
