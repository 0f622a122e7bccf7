#include "particles/stepping/moving_arc.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin::particles {

MovingArc::MovingArc(const WallStep& walls, std::size_t shape)
    : was_(std::get<Arc>(walls.before[shape])),
      step_(walls.displacement[shape]),
      there_(step_),
      back_(inverse(step_)),
      middle_(middle_of(was_).x) {}

WallPosition MovingArc::place_of(Point p) const {
  const Point c = p - was_.center;
  return {angle_from_joint(was_, p), std::hypot(c.x, c.z) - was_.radius};
}

std::optional<WallPath> MovingArc::crossing_of(Point start, Point end, double image) const {
  const Point from{start.x + image, start.z}, to = back_.moved({end.x + image, end.z});
  const Point c = from - was_.center, m = to - from;
  const double along = dot(c, m), squared = dot(m, m);
  const double under = along * along - squared * (dot(c, c) - was_.radius * was_.radius);
  if (!(under > 0) || !(squared > 0)) return std::nullopt;
  int crossings = 0;
  double first = 0;
  for (const double root : {-std::sqrt(under), std::sqrt(under)}) {
    const double share = (root - along) / squared;
    if (share < 0 || share > 1) continue;
    const double angle = std::copysign(1, was_.turn) * angle_from_joint(was_, from + share * m);
    if (angle < -end_margin || angle > std::abs(was_.turn) + end_margin) continue;
    if (crossings++ == 0) first = share;
  }
  if (crossings % 2 == 0) return std::nullopt;
  return WallPath{place_of(from), place_of(to), image, first};
}

std::optional<WallPath> MovingArc::crossing(Point start, Point end, const Period& period) const {
  return crossing_of_images(middle_, start, end, period,
                            [&](double image) { return crossing_of(start, end, image); });
}

Point MovingArc::put_back(const WallPath& path, double radius) const {
  Arc beside = was_;
  beside.radius = std::max(0.0, was_.radius + std::copysign(radius, path.from.across));
  const Point place = there_.moved(at(beside, path.to.along));
  return {place.x - path.image, place.z};
}

double MovingArc::move_across(const WallPath& path) const {
  const Point p = at(was_, path.from.along);
  return std::abs(dot(there_.moved(p) - p, p - was_.center)) / was_.radius;
}

}  // namespace drumlin::particles
