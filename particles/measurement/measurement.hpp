#pragma once
// The measurement of a run: profiles, scalars and their intervals from its snapshots.
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coupling/core/results/profile_scalars.hpp"
#include "coupling/core/results/profile_set.hpp"
#include "coupling/core/results/scalar_set.hpp"
#include "particles/measurement/frame/flow_snapshot.hpp"
#include "particles/measurement/frame/measurement_frame.hpp"
#include "particles/measurement/layers/sensitivity.hpp"
#include "particles/measurement/steadiness.hpp"

namespace drumlin::particles {

struct MeasuredSlice {
  double position = 0, width = 0;
  ProfileSet profiles;  ///< with intervals, z counted from the surface in this slice
  double axis_depth = 0, wall_z = 0;
};

/// Something else that reads the snapshots in the same pass. `begin` is called once the frame is known, then
/// `add` for each snapshot in order of time: as it is and in the flow frame.
struct MeasurementPart {
  std::function<void(const MeasurementFrame&)> begin;
  std::function<void(const Snapshot&, const FlowSnapshot&, std::size_t batch)> add;
};

/// Grains outside of the window of an open scene that reaches further than its limits (dense_window.hpp):
/// they enter no profile and no map.
struct ScatteredGrains {
  double mean = 0;       ///< over the snapshots
  std::size_t most = 0;  ///< in one snapshot
  std::size_t last = 0;  ///< in the last one
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
  double frame_angle_deg = none;     ///< of x below the horizontal
  std::optional<Geometry> geometry;  ///< of layers (geometry_of_layers())
  double axis_depth = none;          ///< height of the drum's axis above the surface
  double surface_z = none;           ///< of z = 0, in the frame of `place`
  double wall_z = none;              ///< of the wall below the slice, of the lowest layer without a drum
  double layer_thickness = none;     ///< used
  double slope_half_width = none;    ///< used
  std::optional<ScatteredGrains> scattered;  ///< nothing when every grain is measured
  Scales scales;

  std::size_t first_snapshot = 0;  ///< snapshots before it belong to another motion of the wall
  double velocity_window = 0;
  double first_time() const { return series.time.front(); }
  double last_time() const { return series.time.back(); }
};

/// The flow of a domain that is periodic in x, told by gravity alone: plane_shear without any, chute
/// where it acts along x, incline where it pulls towards +x and into the layer; nothing for a level bed and
/// for a flow that is pulled towards -x.
std::optional<Geometry> geometry_of_layers(double gravity_x, double gravity_z);

/// Reads every snapshot twice: for the frame, then for all that is measured in it. `progress` (may be empty)
/// is told the snapshots read so far and in all. Throws InputError when there is no snapshot or one without
/// grains, or when a slice leaves the drum.
Measurement measurement(const SnapshotSource& source, const MeasurementOptions& options,
                        std::span<const MeasurementPart> parts = {},
                        const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace drumlin::particles
