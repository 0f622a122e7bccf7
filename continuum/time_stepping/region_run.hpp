#pragma once
// The flow of a region as its scene and law say: its march, its frames, and what the same on coarser cells
// and longer steps says of its error.
#include <vector>

#include "continuum/fem/region_march.hpp"
#include "continuum/model/region_problem.hpp"
#include "continuum/postprocessing/region_frames.hpp"

namespace drumlin::continuum {

/// `coarsening`: cells and steps so many times as large.
RegionMarch region_march(const RegionFlow& flow, double coarsening = 1);

/// Grid and kernel (of one d) of the frames.
FrameRequest frame_request(const RegionFlow& flow);

/// The times at which frames are kept: the start, then those of the flow.
std::vector<double> frame_times(const RegionFlow& flow);

/// What two frames at one time differ by.
struct FrameDifference {
  double time = 0;
  double height_rms = 0;  ///< of mass_height where one of them has material, over the fill's height
  double centre_x = 0, centre_z = 0, discharged = 0;
};
std::vector<FrameDifference> differences(const std::vector<Frame>& fine, const std::vector<Frame>& coarse,
                                         const std::vector<double>& times);

/// What flows with one, two and four times the cells and steps say of the first, in height_rms over all
/// times.
struct RegionAccuracy {
  double change = 0;  ///< by twice
  double order = 0;   ///< of convergence; NaN where four times was not found
  double error = 0;   ///< by Richardson, at an order of 2 at most; NaN below an order of 0.5
};
RegionAccuracy region_accuracy(const std::vector<FrameDifference>& twice,
                               const std::vector<FrameDifference>& four_times);

}  // namespace drumlin::continuum
