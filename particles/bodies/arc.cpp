#include "particles/bodies/arc.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin::particles {
namespace {

// Of its angle, by which a half is felt beyond the joint: a disc that rolls from one half to the other
// touches both for a while, at the same point, and is at no time without one.
constexpr double shared = 0.05;

/// The angle from the joint as a share of the half's: 0 at the joint, 1 at the end.
double share_of(const Arc& arc, Point p) { return angle_from_joint(arc, p) / arc.turn; }

}  // namespace

Point at(const Arc& arc, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {arc.center.x + arc.radius * (c * arc.joint.x - s * arc.joint.z),
          arc.center.z + arc.radius * (s * arc.joint.x + c * arc.joint.z)};
}

std::vector<Point> points_of(const Arc& arc, int pieces) {
  std::vector<Point> points;
  for (int k = 0; k <= pieces; ++k) points.push_back(at(arc, arc.turn * k / pieces));
  return points;
}

double angle_from_joint(const Arc& arc, Point p) {
  const double x = p.x - arc.center.x, z = p.z - arc.center.z;
  return std::atan2(arc.joint.x * z - arc.joint.z * x, arc.joint.x * x + arc.joint.z * z);
}

bool nearest_is_end(const Arc& arc, Point p) {
  const double share = share_of(arc, p);
  return share < -shared || share > 1;
}

Point tangent_at_end(const Arc& arc) {
  const Point end = at(arc, arc.turn);
  const double stretch = std::copysign(1 / arc.radius, arc.turn);
  return {stretch * (end.z - arc.center.z), -stretch * (end.x - arc.center.x)};
}

Point nearest_on(const Arc& arc, Point p) {
  const double x = p.x - arc.center.x, z = p.z - arc.center.z, distance = std::sqrt(x * x + z * z);
  if (!(distance > 0)) return at(arc, 0);
  if (nearest_is_end(arc, p)) return at(arc, arc.turn);
  // By the direction itself: the angle would cost digits.
  const double stretch = arc.radius / distance;
  return {arc.center.x + stretch * x, arc.center.z + stretch * z};
}

Reaches reaches_of(const Arc& arc) {
  const Point first = at(arc, -shared * arc.turn), last = at(arc, arc.turn);
  Reaches reach{std::min(first.x, last.x), std::max(first.x, last.x), std::min(first.z, last.z),
                std::max(first.z, last.z)};
  const auto passes = [&arc](double x, double z) {
    const double share = share_of(arc, {arc.center.x + x, arc.center.z + z});
    return share > -shared && share < 1;
  };
  if (passes(-1, 0)) reach.x_low = arc.center.x - arc.radius;
  if (passes(1, 0)) reach.x_high = arc.center.x + arc.radius;
  if (passes(0, -1)) reach.z_low = arc.center.z - arc.radius;
  if (passes(0, 1)) reach.z_high = arc.center.z + arc.radius;
  return reach;
}

std::array<Arc, 2> halves_of(Point center, double radius, double from, double to) {
  const double middle = (from + to) / 2, half = (to - from) / 2;
  const Point joint{std::cos(middle), std::sin(middle)};
  return {Arc{center, radius, joint, -half}, Arc{center, radius, joint, half}};
}

}  // namespace drumlin::particles
