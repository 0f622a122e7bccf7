#pragma once
// Profiles as means over the grains whose centres lie in a layer, each with its Voronoi cell: the paper's way
// (Sec. II).
#include <cstddef>
#include <cstdint>
#include <vector>

#include "particles/measurement/grains/voronoi_cells.hpp"
#include "particles/measurement/layers/slice.hpp"

namespace drumlin::particles {

/// Sums over the grains with a cell whose centres lie in one layer.
struct CellLayerSum {
  double grains = 0, discs = 0, cells = 0;                     ///< number, areas
  double nu = 0, stress_xx = 0, stress_zz = 0, stress_xz = 0;  ///< contact stress, signs as in the profiles
};

/// Of the layers of a slice, batch by batch.
struct CellSlice {
  VoronoiOptions options;
  std::vector<std::vector<CellLayerSum>> batches;
  std::vector<double> area;         ///< of the cells in the slice, per grain: memory used again
  std::vector<std::int32_t> layer;  ///< of each grain; -1: none
};

CellSlice empty_cell_slice(const Slice& slice, const VoronoiOptions& options = {});

/// Adds a snapshot to the layers of `slice`, on whose frame `in_frame` is.
void add_snapshot(const Slice& slice, const Snapshot& snapshot, const FlowSnapshot& in_frame,
                  std::size_t batch, CellSlice& cells);

/// Adds the columns nu_voronoi (area of discs / area of cells), nu_grains (mean of the grains' own),
/// sigma_xx_grains, sigma_zz_grains, sigma_xz_grains (means of the grains' contact stress) to the profiles of
/// the slice and to those without one batch each.
void add_cell_columns(const Slice& slice, const CellSlice& cells, SliceProfiles& measured);

}  // namespace drumlin::particles
