#pragma once
// Header of the files that a measurement leaves.
#include "coupling/core/results/run_header.hpp"
#include "particles/measurement/measurement.hpp"

namespace drumlin::particles {

/// That of the profile at the centre. `reduced`: the run is that of a smaller drum.
RunHeader measurement_header(const Measurement& measured, const MeasurementOptions& options, bool reduced);
/// The same with the place of one of the narrow slices.
RunHeader slice_header(RunHeader centre, const MeasuredSlice& slice);

}  // namespace drumlin::particles
