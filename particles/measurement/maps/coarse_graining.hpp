#pragma once
// How grains become fields: the nodes of a map, the kernel, and the frame of both.
#include <cstddef>

#include "coupling/core/results/kernel_nodes.hpp"
#include "particles/measurement/frame/flow_frame.hpp"

namespace drumlin::particles {

/// How grains become fields. Lengths in d.
struct CoarseGraining {
  FlowFrame frame;   ///< its origin is that of the grid
  MapGrid grid;      ///< z counted from the frame's origin
  double width = 1;  ///< distance of the knots of the kernel: it reaches 2 width to each side
  /// > 0: columns wrap around after this length, which the grid spans once. 0 in a cell that is periodic in z
  /// too: its images are put on the grid themselves, since its lengths may change.
  double period = 0;
};

/// Nodes over the ranges (frame coordinates), those of grid_over(). period > 0: the columns share it out
/// evenly, from x_from on. `closed`: so do the rows, of a cell that is periodic in z.
CoarseGraining coarse_graining(const FlowFrame& frame, double x_from, double x_to, double z_from, double z_to,
                               double spacing, double width, double period, bool closed = false);

}  // namespace drumlin::particles
