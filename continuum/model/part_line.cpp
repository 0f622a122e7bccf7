#include "continuum/model/part_line.hpp"

#include <algorithm>
#include <numbers>

#include "continuum/model/plane_vector.hpp"

namespace drumlin::continuum {

Vec2 PartLine::at(double s) const {
  if (!round()) return start + s * along;
  return start + radius * Vec2{std::cos(s / radius), std::sin(s / radius)};
}

Vec2 PartLine::tangent(double s) const {
  if (!round()) return along;
  return {-std::sin(s / radius), std::cos(s / radius)};
}

double PartLine::nearest(Vec2 point) const {
  const Vec2 r = point - start;
  if (!round()) return dot(r, along);
  const double angle = std::atan2(r.z, r.x);
  return radius * (angle < 0 ? angle + 2 * std::numbers::pi : angle);
}

double PartLine::distance(Vec2 point) const {
  const Vec2 r = point - start;
  return std::abs(round() ? continuum::length(r) - radius : cross(along, r));
}

PartLine line_of(const RegionPart& part, double time) {
  if (const auto* circle = std::get_if<CircleCurve>(&part.curve))
    return {circle->center, {}, 2 * std::numbers::pi * circle->radius, circle->radius};
  const auto& segment = std::get<SegmentCurve>(part.curve);
  const Vec2 side = segment.to - segment.from, moved = std::max(0.0, time - part.begins) * part.velocity;
  return {segment.from + moved, (1 / length(side)) * side, length(side)};
}

Vec2 nearest_point(const SegmentCurve& segment, Vec2 point) {
  const Vec2 side = segment.to - segment.from;
  return segment.from + std::clamp(dot(point - segment.from, side) / dot(side, side), 0.0, 1.0) * side;
}

bool is_there(const RegionPart& part, double time) { return time < part.ends; }

bool is_open(const RegionPart& part, double time) {
  return part.kind == RegionPart::Kind::opening && time >= part.begins;
}

}  // namespace drumlin::continuum
