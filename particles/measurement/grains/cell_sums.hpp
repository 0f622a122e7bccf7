#pragma once
// Sums over the grains whose centres lie in a layer, each with its Voronoi cell: the paper's way (Sec. II).
#include "particles/measurement/grains/voronoi_cells.hpp"
#include "particles/measurement/layers/layer_sums.hpp"

namespace drumlin::particles {

/// Adds LayerSum::cells of a snapshot, on whose frame `in_frame` is. Stresses are those of the contacts, with
/// the signs of the profiles.
void add_cells(const LayerGrid& grid, const Snapshot& snapshot, const FlowSnapshot& in_frame,
               LayerSums& sums);

}  // namespace drumlin::particles
