#pragma once
// Options of a measurement, and the frame that it found to measure in.
#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "coupling/core/results/profile_scalars.hpp"
#include "particles/measurement/frame/flow_frame.hpp"
#include "particles/measurement/frame/survey.hpp"

namespace drumlin::particles {

/// Narrow slices, to follow the flow along the surface. The paper, Sec. III B: five of them, 2 d wide.
struct SlicesRequest {
  std::vector<double> positions;  ///< x of their middles, d; empty: 0, +-0.3, +-0.6 of half the chord
  double width = 2;               ///< d
};

/// Lengths in d. What is not asked for is neither computed nor stored.
struct MeasurementOptions {
  std::optional<double> since_s = {};  ///< snapshots before are left out
  double position = 0;                 ///< x of the slice
  double slice_width = 20;  ///< cut to a quarter of the surface's chord, or to the width of what there is
  double layer_thickness = 1;
  double slope_isoline = 0.4;       ///< volume fraction of the line that gives the slope
  double slope_half_width = 20;     ///< cut to a quarter of the chord
  double surface_nu = 0.7;          ///< volume fraction that marks z = 0
  double bulk_margin = 4;           ///< nu_bulk keeps this distance from the surface and from the wall
  double wall_margin = 3;           ///< so do means over the static phase, from the wall
  double fluctuation_I_min = 1e-4;  ///< least I of the power laws of the fluctuations
  std::size_t batches = 20;         ///< of the intervals
  ProfileScalarOptions scalars = {};
  /// Where a file without a name takes what does not fit into memory.
  std::filesystem::path scratch_folder = std::filesystem::temp_directory_path();

  std::optional<double> gradient_step =
      {};  ///< derivatives from slices at position -+ this; cut to a quarter of half the chord
  std::optional<SlicesRequest> slices = {};  ///< more profiles; none in a periodic domain
  bool sensitivity = false;                  ///< the scalars by other windows as well
  bool voronoi = false;                      ///< columns of the middle slice by Voronoi cells
};

/// Where and how a run is measured: what a part needs to know before it sees the first snapshot.
struct MeasurementFrame {
  FlowFrame frame;  ///< origin on the drum's axis
  FrameSource source = FrameSource::gravity;
  double container_radius = 0;  ///< 0 without a drum
  double period = 0;            ///< 0: open
  bool closed = false;          ///< periodic in z too, over the height of `reach` in the mean
  Rectangle reach;              ///< of the grains, or the window; -+ the radius in a drum
  double rotation = 0;          ///< of the drum, clockwise
  double slice_width = 0;       ///< of the slice in the middle
  double gradient_step = 0;     ///< used; 0: no derivatives along x
  double half_chord = 0;        ///< of the surface; infinite without a drum
  std::size_t snapshots = 0, batches = 0;
  bool in_mirror = false;  ///< snapshots are seen in a vertical mirror (Measurement)
};

}  // namespace drumlin::particles
