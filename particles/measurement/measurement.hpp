#pragma once
// From the snapshots of a run to its profiles and scalars.
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "coupling/exchange/profile_scalars.hpp"
#include "coupling/exchange/profile_set.hpp"
#include "coupling/exchange/scalar_set.hpp"
#include "particles/measurement/flow_frame.hpp"
#include "particles/measurement/snapshot.hpp"

namespace drumlin {

/// Snapshots in order of time, fetched one by one: a long run does not fit in memory.
struct SnapshotSource {
  std::size_t count = 0;
  std::function<Snapshot(std::size_t)> read;
};

/// Lengths in d.
struct MeasurementOptions {
  double position = 0;      ///< x of the slice
  double slice_width = 20;  ///< cut to a quarter of the surface's chord, or to the width of what there is
  double layer_thickness = 1;
  double slope_isoline = 0.4;    ///< volume fraction of the line that gives the slope
  double slope_half_width = 20;  ///< cut to a quarter of the chord
  double surface_nu = 0.7;       ///< volume fraction that marks z = 0
  double bulk_margin = 4;        ///< nu_bulk keeps this distance from the surface and from the wall
  std::size_t batches = 20;      ///< of the intervals
  ProfileScalarOptions scalars;
};

/// How the direction of the surface was found.
enum class FrameSource { isoline, centre_of_mass, gravity, domain };
std::string name_of(FrameSource source);

/// What came of it, dimensionless; NaN where it was not measured. The drum turns clockwise here: one that
/// turns the other way is seen in a mirror.
struct Measurement {
  static constexpr double none = ProfileScalars::none;

  ProfileSet profiles;  ///< with intervals
  /// The profiles without one batch each, for the intervals of what is derived from them.
  std::vector<ProfileSet> leave_one_out;
  /// theta_deg, theta_com_deg, Q, H, lambda, shear_rate, I_th, nu_bulk, spin_over_half_vorticity,
  /// spin_over_half_curl, dv_over_shear, domega_over_shear, k_flowing, Q_expected.
  ScalarSet scalars;
  ProfileScalars fits;  ///< of the whole run

  FrameSource frame_source = FrameSource::gravity;
  double frame_angle_deg = none;   ///< of x below the horizontal
  double axis_depth = none;        ///< height of the drum's axis above the surface
  double wall_z = none;            ///< of the wall below the slice, of the lowest layer without a drum
  double slope_half_width = none;  ///< used
  double slice_width = none;       ///< used
  double rotation = 0;             ///< of the drum, clockwise
  double container_radius = 0;     ///< 0 without a drum
  bool in_mirror = false;
  Scales scales;

  std::size_t first_snapshot = 0;  ///< snapshots before it belong to another motion of the wall
  std::size_t snapshots = 0;       ///< used
  std::size_t batches = 0;
  double first_time = 0, last_time = 0;
  double velocity_window = 0;
};

/// Reads every snapshot twice: for the frame, then for the layers. `progress` (may be empty) is told the
/// snapshots read so far and in all. Throws InputError when there is no snapshot or one without grains, or
/// when the slice leaves the drum.
Measurement measurement(const SnapshotSource& source, const MeasurementOptions& options,
                        const std::function<void(std::size_t done, std::size_t total)>& progress = {});

}  // namespace drumlin
