#include "continuum/model/region_problem.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace {

/// From the scene's units to those of its grains.
struct ToGrains {
  Scales scales;
  double length(double mm) const { return 1e-3 * mm / scales.length_m; }
  Vec2 point(const FlowPoint_mm& mm) const { return {length(mm[0]), length(mm[1])}; }
  double time(double s) const { return s / scales.time_s; }
  Vec2 velocity(const std::array<double, 2>& mm_s) const {
    return {length(mm_s[0]) * scales.time_s, length(mm_s[1]) * scales.time_s};
  }
  double rotation(double rpm) const { return rpm * std::numbers::pi / 30 * scales.time_s; }
};

void set_shape(const ToGrains& in, const FlowSegment& segment, RegionPart& part) {
  part.curve = SegmentCurve{in.point(segment.from_mm), in.point(segment.to_mm)};
  part.velocity = in.velocity(segment.velocity_mm_s);
}
void set_shape(const ToGrains& in, const FlowCircle& circle, RegionPart& part) {
  part.curve = CircleCurve{in.point(circle.center_mm), in.length(circle.radius_mm)};
  part.rotation = in.rotation(circle.rotation_rpm);
}

RegionPart part_of(const ToGrains& in, const FlowWall& wall) {
  RegionPart part;
  part.name = wall.name;
  std::visit([&](const auto& shape) { set_shape(in, shape, part); }, wall.shape);
  if (!std::holds_alternative<FlowRoughWall>(wall.condition)) part.kind = RegionPart::Kind::friction;
  if (const auto* sliding = std::get_if<FlowFrictionWall>(&wall.condition)) part.friction = sliding->friction;
  part.begins = in.time(wall.begins_s);
  if (wall.ends_s) part.ends = in.time(*wall.ends_s);
  return part;
}

/// How far the region reaches along one axis.
FrameAxis reach(const Region& region, double Vec2::*axis) {
  FrameAxis found{region.fill.front().*axis, region.fill.front().*axis};
  const auto take = [&](double at) { found = {std::min(found.from, at), std::max(found.to, at)}; };
  for (const Vec2& point : region.fill) take(point.*axis);
  for (const RegionPart& part : region.parts)
    if (const auto* circle = std::get_if<CircleCurve>(&part.curve)) {
      take(circle->center.*axis - circle->radius);
      take(circle->center.*axis + circle->radius);
    } else {
      const auto& segment = std::get<SegmentCurve>(part.curve);
      take(segment.from.*axis);
      take(segment.to.*axis);
    }
  return found;
}

FrameAxis axis_of(const ToGrains& in, const std::optional<std::array<double, 2>>& asked_mm,
                  const FrameAxis& reach) {
  return asked_mm ? FrameAxis{in.length((*asked_mm)[0]), in.length((*asked_mm)[1])} : reach;
}

void refuse_law(const RheologyFit& law) {
  if (law.k)
    throw InputError({InputProblem{.file = "",
                                   .key = "region",
                                   .what = "takes no k(I), which the law has",
                                   .allowed = "a rheology file without a table [k]"}});
}

}  // namespace

Region region_of(const FlowScene& scene) {
  const auto& asked = std::get<FlowRegion>(scene.geometry);
  const ToGrains in{scales_of(scene)};
  Region region;
  for (const FlowWall& wall : asked.walls) region.parts.push_back(part_of(in, wall));
  for (const FlowOpening& opening : asked.openings)
    region.parts.push_back({.name = opening.name,
                            .curve = SegmentCurve{in.point(opening.from_mm), in.point(opening.to_mm)},
                            .kind = RegionPart::Kind::opening,
                            .begins = in.time(opening.begins_s)});
  for (const FlowPoint_mm& point : asked.fill_mm) region.fill.push_back(in.point(point));
  return region;
}

RegionFlow region_flow(const FlowScene& scene, const RheologyFit& law) {
  refuse_law(law);
  const auto& asked = std::get<FlowRegion>(scene.geometry);
  const ToGrains in{scales_of(scene)};
  RegionFlow flow;
  flow.region = region_of(scene);
  flow.law = stress_law(law);
  flow.nu = law.nu;
  const double direction = scene.gravity.direction_deg.value() * std::numbers::pi / 180;
  flow.gravity = {std::cos(direction), std::sin(direction)};
  flow.regularisation = {scene.regularisation.shear_rate, scene.regularisation.pressure};
  flow.cell = asked.mesh.cell;
  flow.slot_cell = asked.mesh.slot_cell;
  flow.step = in.time(asked.time.step_s);
  flow.end = in.time(asked.time.end_s);
  for (const double frame : frames_s(asked.time)) flow.frames.push_back(in.time(frame));
  flow.spacing = asked.output.map_spacing;
  flow.x = axis_of(in, asked.output.x_mm, reach(flow.region, &Vec2::x));
  flow.z = axis_of(in, asked.output.z_mm, reach(flow.region, &Vec2::z));
  return flow;
}

}  // namespace drumlin::continuum
