#pragma once
// Frames of a flow with a free surface: averaged as those of grains are (docs/formats/frames.md).
#include "continuum/fem/region_march.hpp"
#include "coupling/core/results/frames.hpp"

namespace drumlin::continuum {

/// How frames are averaged.
struct FrameRequest {
  MapGrid grid;             ///< d, axes of the scene
  double kernel_width = 0;  ///< d
  double nu = 0;
};

/// The frame of a state, with its flow and the step that led there. Loads bear the names of the parts.
Frame region_frame(const FrameRequest& request, const Region& region, const RegionState& state,
                   const RegionStep& step, const FlowField& field);

}  // namespace drumlin::continuum
