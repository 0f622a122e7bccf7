#include "continuum/time_stepping/region_run.hpp"

#include <algorithm>
#include <cmath>

#include "continuum/model/part_line.hpp"
#include "continuum/model/plane_vector.hpp"
#include "coupling/core/basics/no_value.hpp"
#include "coupling/core/results/kernel_nodes.hpp"

namespace drumlin::continuum {
namespace {

constexpr double growth = 0.25;  // of the cells per distance from an opening

}  // namespace

RegionMarch region_march(const RegionFlow& flow, double coarsening) {
  RegionMarch march;
  march.region = flow.region;
  march.step = coarsening * flow.step;
  march.problem.law = flow.law;
  march.problem.density = flow.nu;
  march.problem.regularisation = flow.regularisation;
  march.problem.slope = FixedSlope{std::atan2(flow.gravity.x, -flow.gravity.z)};
  std::vector<SegmentCurve> openings;
  for (const RegionPart& part : flow.region.parts)
    if (part.kind == RegionPart::Kind::opening) openings.push_back(std::get<SegmentCurve>(part.curve));
  march.size = [openings, coarsening, cell = flow.cell, slot = flow.slot_cell](Vec2 x) {
    double size = cell;
    for (const SegmentCurve& opening : openings)
      size = std::min(size, slot + growth / coarsening * length(x - nearest_point(opening, x)));
    return coarsening * size;
  };
  march.end = flow.end;
  return march;
}

FrameRequest frame_request(const RegionFlow& flow) {
  constexpr double width = 1;
  return {grid_over(flow.x.from, flow.x.to, flow.z.from, flow.z.to, flow.spacing, width), width, flow.nu};
}

std::vector<double> frame_times(const RegionFlow& flow) {
  std::vector<double> times{0};
  for (const double time : flow.frames)
    if (time > 0) times.push_back(time);
  if (times.back() < flow.end) times.push_back(flow.end);
  return times;
}

std::vector<FrameDifference> differences(const std::vector<Frame>& fine, const std::vector<Frame>& coarse,
                                         const std::vector<double>& times) {
  std::vector<FrameDifference> all;
  const double fill = *std::ranges::max_element(fine.front().mass_height);
  for (std::size_t t = 0; t < times.size(); ++t) {
    const Frame &a = fine[t], &b = coarse[t];
    double squares = 0;
    int columns = 0;
    for (std::size_t c = 0; c < a.mass_height.size(); ++c) {
      const double difference = a.mass_height[c] - b.mass_height[c];
      squares += difference * difference;
      columns += a.mass_height[c] > 0 || b.mass_height[c] > 0;
    }
    const auto scalar = [&](const char* name) { return a.scalars.at(name) - b.scalars.at(name); };
    all.push_back({times[t], std::sqrt(squares / std::max(1, columns)) / fill, scalar("centre_x"),
                   scalar("centre_z"), scalar("discharged")});
  }
  return all;
}

RegionAccuracy region_accuracy(const std::vector<FrameDifference>& twice,
                               const std::vector<FrameDifference>& four_times) {
  constexpr double least_order = 0.5, most_order = 2;
  const auto height = [](const std::vector<FrameDifference>& all) {
    double squares = 0;
    for (const auto& d : all) squares += d.height_rms * d.height_rms;
    return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, all.size())));
  };
  RegionAccuracy accuracy{height(twice), no_value, no_value};
  if (four_times.empty()) return accuracy;
  accuracy.order = std::log2(height(four_times) / accuracy.change);
  if (accuracy.order >= least_order)
    accuracy.error = accuracy.change / (std::exp2(std::min(accuracy.order, most_order)) - 1);
  return accuracy;
}

}  // namespace drumlin::continuum
