#pragma once
// Slices by other windows, summed in the second reading, and the scalars by each of them.
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "particles/measurement/frame/measurement_frame.hpp"
#include "particles/measurement/layers/sensitivity.hpp"
#include "particles/measurement/layers/slice.hpp"

namespace drumlin::particles {

/// The layers of a slice of `width` about `position`. Throws InputError when it leaves the drum.
LayerGrid slice_grid(const MeasurementFrame& place, double position, double width, double thickness);

/// Slices of other widths, layers of another thickness, other velocities, another frame. Each has one batch.
struct VariantSlices {
  struct One {
    std::string change;
    Slice slice;
    double frame_angle = 0;
  };
  std::vector<One> in_the_frame;        ///< by the velocity over the window
  std::optional<One> instantaneous;     ///< by the velocity at the instant of the snapshot
  std::optional<One> mass_angle_frame;  ///< in the frame at the angle of the centre of mass
  /// Pairs of slices that give the derivatives along x by another step.
  struct Pair {
    double step = 0;
    Slice west, east;
  };
  std::vector<Pair> gradients;
};
VariantSlices variant_slices(const Survey& found, const MeasurementFrame& place, double frame_angle,
                             const MeasurementOptions& options);
/// Leaves `in_frame` in another frame: its memory is used for those of the variants.
void add_snapshot(VariantSlices& variants, const Snapshot& snapshot, FlowSnapshot& in_frame);

/// All variants: of the slices, of the windows that are applied to the profile of `centre`, and of the
/// slope's.
std::vector<ScalarVariant> scalar_variants(const VariantSlices& variants, const Survey& found,
                                           const MeasurementFrame& place, const Slice& centre,
                                           double wall_height, double frame_angle,
                                           const MeasurementOptions& options);

}  // namespace drumlin::particles
