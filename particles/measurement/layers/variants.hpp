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

/// A slice of another width, with layers of another thickness, other velocities or another frame; two of
/// them give the derivatives along x by another step. Each has one batch.
struct VariantSlice {
  std::string change;
  std::vector<Slice> slices;
  double frame_angle = 0;
  std::optional<VelocityKind> own_view = {};  ///< by these velocities, in the frame of its own grid
  double step = 0;                            ///< of the derivatives; 0: the slice stands for the whole
};
std::vector<VariantSlice> variant_slices(const Survey& found, const MeasurementFrame& place,
                                         double frame_angle, const MeasurementOptions& options);
/// Leaves `in_frame` in another frame: its memory is used for those of the variants.
void add_snapshot(std::vector<VariantSlice>& variants, const Snapshot& snapshot, FlowSnapshot& in_frame);

/// All variants: of the windows that are applied to the profile of `centre`, of the slices, and of the
/// slope's.
std::vector<ScalarVariant> scalar_variants(const std::vector<VariantSlice>& variants, const Survey& found,
                                           const MeasurementFrame& place, const Slice& centre,
                                           double wall_height, double frame_angle,
                                           const MeasurementOptions& options);

}  // namespace drumlin::particles
