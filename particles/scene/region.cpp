#include "particles/scene/region.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "particles/bodies/arc.hpp"
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

/// Whether the point of an arc's circle at an angle from +x lies on the arc.
bool holds(const ArcShape& arc, double angle) {
  const double turn = std::fmod(std::fmod(angle / radian - arc.from_deg, 360) + 360, 360);
  return turn <= arc.to_deg - arc.from_deg;
}

Point_mm point_at(const ArcShape& arc, double angle) {
  return {arc.center_mm[0] + arc.radius_mm * std::cos(angle),
          arc.center_mm[1] + arc.radius_mm * std::sin(angle)};
}

double distance_to_arc(const Point_mm& p, const ArcShape& arc) {
  double least = std::numeric_limits<double>::infinity();
  for (const Arc& half : halves_of({arc.center_mm[0], arc.center_mm[1]}, arc.radius_mm, arc.from_deg * radian,
                                   arc.to_deg * radian)) {
    const Point nearest = nearest_on(half, {p[0], p[1]});
    least = std::min(least, distance(p, {nearest.x, nearest.z}));
  }
  return least;
}

/// Whether an end of the arc lies inside the rectangle, or the arc cuts one of its sides.
bool arc_enters(const ArcShape& arc, const RectangleRegion& box) {
  const auto inside = [&box](const Point_mm& p, int axis) {
    return p[axis] > box.min_mm[axis] && p[axis] < box.max_mm[axis];
  };
  const Point_mm end = point_at(arc, arc.from_deg * radian);
  if (inside(end, 0) && inside(end, 1)) return true;
  for (const int axis : {0, 1})
    for (const double side : {box.min_mm[axis], box.max_mm[axis]}) {
      const double share = (side - arc.center_mm[axis]) / arc.radius_mm;
      if (!(std::abs(share) < 1)) continue;
      const double first = axis == 0 ? std::acos(share) : std::asin(share);
      for (const double angle : {first, axis == 0 ? -first : std::numbers::pi - first})
        if (holds(arc, angle) && inside(point_at(arc, angle), 1 - axis)) return true;
    }
  return false;
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

bool inside(const Region& region, const Point_mm& center, double radius) {
  if (const auto* circle = std::get_if<CircleRegion>(&region))
    return std::hypot(center[0] - circle->center_mm[0], center[1] - circle->center_mm[1]) + radius <=
           circle->radius_mm;
  const auto& box = std::get<RectangleRegion>(region);
  return center[0] - radius >= box.min_mm[0] && center[0] + radius <= box.max_mm[0] &&
         center[1] - radius >= box.min_mm[1] && center[1] + radius <= box.max_mm[1];
}

double distance_mm(const WallShape& shape, const Point_mm& point) {
  if (const auto* s = std::get_if<SegmentShape>(&shape)) return distance_to_segment(point, *s);
  if (const auto* a = std::get_if<ArcShape>(&shape)) return distance_to_arc(point, *a);
  if (const auto* d = std::get_if<DiscShape>(&shape))
    return distance(point, d->center_mm) - d->diameter_mm / 2;
  if (const auto* c = std::get_if<ContainerShape>(&shape))
    return c->radius_mm - distance(point, c->center_mm);
  double least = std::numeric_limits<double>::infinity();
  for (const SegmentShape& s : segments_of(std::get<PolylineShape>(shape)))
    least = std::min(least, distance_to_segment(point, s));
  return least;
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
  const auto* arc = std::get_if<ArcShape>(&shape);
  if (const auto* circle = std::get_if<CircleRegion>(&region)) {
    if (segment) return distance_to_segment(circle->center_mm, *segment) < circle->radius_mm - margin;
    if (arc) return distance_to_arc(circle->center_mm, *arc) < circle->radius_mm - margin;
    if (disc)
      return distance(circle->center_mm, disc->center_mm) <
             circle->radius_mm + disc->diameter_mm / 2 - margin;
    return false;
  }
  const auto& box = std::get<RectangleRegion>(region);
  if (segment) return segment_enters(*segment, shrunk(box, margin));
  if (arc) return arc_enters(*arc, shrunk(box, margin));
  if (!disc) return false;
  const Point_mm nearest{std::clamp(disc->center_mm[0], box.min_mm[0], box.max_mm[0]),
                         std::clamp(disc->center_mm[1], box.min_mm[1], box.max_mm[1])};
  return distance(nearest, disc->center_mm) < disc->diameter_mm / 2 - margin;
}

}  // namespace drumlin::particles
