#include "particles/scene/region.hpp"

#include <algorithm>
#include <cmath>

#include "particles/scene/scene_walls.hpp"

namespace drumlin::particles {

namespace {

double distance(const Point_mm& a, const Point_mm& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

double distance_to_segment(const Point_mm& p, const SegmentShape& s) {
  const double dx = s.to_mm[0] - s.from_mm[0], dz = s.to_mm[1] - s.from_mm[1];
  const double length2 = dx * dx + dz * dz;
  const double along = length2 > 0 ? ((p[0] - s.from_mm[0]) * dx + (p[1] - s.from_mm[1]) * dz) / length2 : 0;
  const double share = std::clamp(along, 0.0, 1.0);
  return distance(p, {s.from_mm[0] + share * dx, s.from_mm[1] + share * dz});
}

/// Liang-Barsky: whether a part of the segment lies inside the rectangle.
bool segment_enters(const SegmentShape& s, const RectangleRegion& box) {
  double from = 0, to = 1;
  for (int axis : {0, 1}) {
    const double start = s.from_mm[axis], step = s.to_mm[axis] - start;
    if (step == 0) {
      if (start <= box.min_mm[axis] || start >= box.max_mm[axis]) return false;
    } else {
      const double a = (box.min_mm[axis] - start) / step, b = (box.max_mm[axis] - start) / step;
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
  }
  return from < to;
}

RectangleRegion shrunk(const RectangleRegion& box, double margin) {
  return {{box.min_mm[0] + margin, box.min_mm[1] + margin}, {box.max_mm[0] - margin, box.max_mm[1] - margin}};
}

}  // namespace

std::pair<double, double> extent_mm(const Region& region, int axis) {
  if (const auto* circle = std::get_if<CircleRegion>(&region))
    return {circle->center_mm[axis] - circle->radius_mm, circle->center_mm[axis] + circle->radius_mm};
  const auto& box = std::get<RectangleRegion>(region);
  return {box.min_mm[axis], box.max_mm[axis]};
}

double farthest_mm(const Region& region, const Point_mm& center) {
  if (const auto* circle = std::get_if<CircleRegion>(&region))
    return distance(circle->center_mm, center) + circle->radius_mm;
  const auto& box = std::get<RectangleRegion>(region);
  double farthest = 0;
  for (double x : {box.min_mm[0], box.max_mm[0]})
    for (double z : {box.min_mm[1], box.max_mm[1]}) farthest = std::max(farthest, distance({x, z}, center));
  return farthest;
}

bool crosses(const Region& region, const WallShape& shape, double tolerance) {
  if (const auto* line = std::get_if<PolylineShape>(&shape)) {
    const auto segments = segments_of(*line);
    return std::any_of(segments.begin(), segments.end(),
                       [&](const SegmentShape& s) { return crosses(region, s, tolerance); });
  }
  const auto [low, high] = extent_mm(region, 0);
  const double margin = tolerance * (high - low);
  const auto* segment = std::get_if<SegmentShape>(&shape);
  const auto* disc = std::get_if<DiscShape>(&shape);
  if (const auto* circle = std::get_if<CircleRegion>(&region)) {
    if (segment) return distance_to_segment(circle->center_mm, *segment) < circle->radius_mm - margin;
    if (disc)
      return distance(circle->center_mm, disc->center_mm) <
             circle->radius_mm + disc->diameter_mm / 2 - margin;
    return false;
  }
  const auto& box = std::get<RectangleRegion>(region);
  if (segment) return segment_enters(*segment, shrunk(box, margin));
  if (!disc) return false;
  const Point_mm nearest{std::clamp(disc->center_mm[0], box.min_mm[0], box.max_mm[0]),
                         std::clamp(disc->center_mm[1], box.min_mm[1], box.max_mm[1])};
  return distance(nearest, disc->center_mm) < disc->diameter_mm / 2 - margin;
}

}  // namespace drumlin::particles
