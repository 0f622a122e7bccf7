#pragma once
// From the snapshots of a run to its profiles and scalars.
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coupling/exchange/profile_scalars.hpp"
#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/scalar_set.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/frame/survey.hpp"
#include "particles/measurement/layers/sensitivity.hpp"
#include "particles/measurement/steadiness.hpp"

namespace drumlin {

/// Narrow slices, to follow the flow along the surface. The paper, Sec. III B: five of them, 2 d wide.
struct SlicesRequest {
  std::vector<double> positions;  ///< x of their middles, d; empty: 0, +-0.3, +-0.6 of half the chord
  double width = 2;               ///< d
};

struct MeasuredSlice {
  double position = 0, width = 0;
  ProfileSet profiles;  ///< with intervals, z counted from the surface in this slice
  double axis_depth = 0, wall_z = 0;
};

/// Lengths in d. What is not asked for is neither computed nor stored.
struct MeasurementOptions {
  double position = 0;      ///< x of the slice
  double slice_width = 20;  ///< cut to a quarter of the surface's chord, or to the width of what there is
  double layer_thickness = 1;
  double slope_isoline = 0.4;       ///< volume fraction of the line that gives the slope
  double slope_half_width = 20;     ///< cut to a quarter of the chord
  double surface_nu = 0.7;          ///< volume fraction that marks z = 0
  double bulk_margin = 4;           ///< nu_bulk keeps this distance from the surface and from the wall
  double wall_margin = 3;           ///< so do means over the static phase, from the wall
  double fluctuation_I_min = 1e-4;  ///< least I of the power laws of the fluctuations
  std::size_t batches = 20;         ///< of the intervals
  ProfileScalarOptions scalars;

  std::optional<double>
      gradient_step;  ///< derivatives from slices at position -+ this; cut to a quarter of half the chord
  std::optional<SlicesRequest> slices;  ///< more profiles; none in a periodic domain
  bool sensitivity = false;             ///< the scalars by other windows as well
  bool voronoi = false;                 ///< columns of the middle slice by Voronoi cells
};

/// Where and how a run is measured: what a part needs to know before it sees the first snapshot.
struct MeasurementFrame {
  FlowFrame frame;  ///< origin on the drum's axis
  FrameSource source = FrameSource::gravity;
  double container_radius = 0;  ///< 0 without a drum
  double period = 0;            ///< 0: open
  double z_min = 0, z_max = 0;  ///< what the layers cover
  double x_min = 0, x_max = 0;  ///< what the grains reach along x; -+ the radius in a drum
  double rotation = 0;          ///< of the drum, clockwise
  double slice_width = 0;       ///< of the slice in the middle
  double gradient_step = 0;     ///< used; 0: no derivatives along x
  double half_chord = 0;        ///< of the surface; infinite without a drum
  std::size_t snapshots = 0, batches = 0;
};

/// Something else that reads the snapshots in the same pass. `begin` is called once the frame is known, then
/// `add` for each snapshot in order of time: as it is and in the flow frame.
struct MeasurementPart {
  std::function<void(const MeasurementFrame&)> begin;
  std::function<void(const Snapshot&, const FlowSnapshot&, std::size_t batch)> add;
};

/// What came of it, dimensionless; NaN where it was not measured. The drum turns clockwise here: one that
/// turns the other way is seen in a mirror.
struct Measurement {
  static constexpr double none = ProfileScalars::none;

  ProfileSet profiles;  ///< with intervals
  /// The profiles without one batch each, for the intervals of what is derived from them.
  std::vector<ProfileSet> leave_one_out;
  std::vector<MeasuredSlice> slices;
  /// Those of docs/theory/measurement.md.
  ScalarSet scalars;
  ProfileScalars fits;                  ///< of the whole run
  std::vector<ScalarVariant> variants;  ///< the scalars by other windows; empty unless asked for
  TimeSeries series;
  Steadiness steadiness;

  MeasurementFrame place;
  double frame_angle_deg = none;   ///< of x below the horizontal
  double axis_depth = none;        ///< height of the drum's axis above the surface
  double surface_z = none;         ///< of z = 0, in the frame of `place`
  double wall_z = none;            ///< of the wall below the slice, of the lowest layer without a drum
  double slope_half_width = none;  ///< used
  bool in_mirror = false;
  Scales scales;

  std::size_t first_snapshot = 0;  ///< snapshots before it belong to another motion of the wall
  double velocity_window = 0;
  double first_time() const { return series.time.front(); }
  double last_time() const { return series.time.back(); }
};

/// Reads every snapshot twice: for the frame, then for all that is measured in it. `progress` (may be empty)
/// is told the snapshots read so far and in all. Throws InputError when there is no snapshot or one without
/// grains, or when a slice leaves the drum.
Measurement measurement(const SnapshotSource& source, const MeasurementOptions& options,
                        std::span<const MeasurementPart> parts = {},
                        const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace drumlin
