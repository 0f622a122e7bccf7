#include "particles/measurement/grains/convex_polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "particles/measurement/frame/disc_area.hpp"

namespace drumlin::particles {
namespace {

double cross(PlanePoint a, PlanePoint b) { return a.x * b.z - a.z * b.x; }

/// Where the line through p and q enters and leaves a disc; empty when it passes by.
LinePart within_disc(PlanePoint p, PlanePoint q, const Circle& disc) {
  const double along_x = q.x - p.x, along_z = q.z - p.z;
  const double from_x = p.x - disc.x, from_z = p.z - disc.z;
  const double a = along_x * along_x + along_z * along_z;
  const double b = from_x * along_x + from_z * along_z;
  const double c = from_x * from_x + from_z * from_z - disc.radius * disc.radius;
  const double root_squared = b * b - a * c;
  if (!(a > 0) || !(root_squared > 0)) return {0, 0};
  const double root = std::sqrt(root_squared);
  // The root without cancellation, then the other one from the product of both.
  const double big = b > 0 ? -b - root : -b + root;
  const double one = big / a, other = c / big;
  return {std::min(one, other), std::max(one, other)};
}

PlanePoint point_on(const Circle& circle, double angle) {
  return {circle.x + circle.radius * std::cos(angle), circle.z + circle.radius * std::sin(angle)};
}

bool holds(const Circle& disc, PlanePoint p) {
  return (p.x - disc.x) * (p.x - disc.x) + (p.z - disc.z) * (p.z - disc.z) <= disc.radius * disc.radius;
}

/// Two cuts that meet in a corner may leave it twice: such an edge is all rounding and has no side. Hence the
/// `tolerance`, an area.
bool holds(std::span<const PlanePoint> corners, PlanePoint p, double tolerance) {
  PlanePoint a = corners.back();
  for (const PlanePoint b : corners) {
    if (cross({b.x - a.x, b.z - a.z}, {p.x - a.x, p.z - a.z}) < -tolerance) return false;
    a = b;
  }
  return true;
}

/// Angles at which a circle crosses the polygon's edges and another circle.
void add_crossings(const Circle& circle, std::span<const PlanePoint> corners, std::span<const Circle> discs,
                   std::vector<double>& angles) {
  const auto add = [&](double x, double z) { angles.push_back(std::atan2(z - circle.z, x - circle.x)); };
  PlanePoint p = corners.back();
  for (const PlanePoint q : corners) {
    const LinePart part = within_disc(p, q, circle);
    if (!part.empty())
      for (const double s : {part.begin, part.end})
        if (s >= 0 && s <= 1) add(p.x + s * (q.x - p.x), p.z + s * (q.z - p.z));
    p = q;
  }
  for (const Circle& other : discs) {
    const double apart_x = other.x - circle.x, apart_z = other.z - circle.z;
    const double apart = std::hypot(apart_x, apart_z);
    const double chord_at =  // distance of the common chord from the centre of `circle`
        (apart * apart + circle.radius * circle.radius - other.radius * other.radius) / (2 * apart);
    if (!(apart > 0) || !(std::abs(chord_at) < circle.radius)) continue;
    const double middle = std::atan2(apart_z, apart_x), half = std::acos(chord_at / circle.radius);
    for (const double angle : {middle - half, middle + half})
      angles.push_back(std::remainder(angle, 2 * std::numbers::pi));
  }
}

}  // namespace

void ConvexPolygon::make_square(double half_side) {
  corners_.assign(
      {{-half_side, -half_side}, {half_side, -half_side}, {half_side, half_side}, {-half_side, half_side}});
}

void ConvexPolygon::cut(double normal_x, double normal_z, double offset) {
  if (corners_.empty()) return;
  std::swap(corners_, old_);
  corners_.clear();
  PlanePoint p = old_.back();
  double p_beyond = normal_x * p.x + normal_z * p.z - offset;
  for (const PlanePoint q : old_) {
    const double q_beyond = normal_x * q.x + normal_z * q.z - offset;
    if ((p_beyond > 0) != (q_beyond > 0)) {
      const double s = p_beyond / (p_beyond - q_beyond);
      corners_.push_back({p.x + s * (q.x - p.x), p.z + s * (q.z - p.z)});
    }
    if (!(q_beyond > 0)) corners_.push_back(q);
    p = q;
    p_beyond = q_beyond;
  }
  if (corners_.size() < 3) corners_.clear();
}

double ConvexPolygon::largest_distance_squared() const {
  double largest = 0;
  for (const PlanePoint p : corners_) largest = std::max(largest, p.x * p.x + p.z * p.z);
  return largest;
}

double ConvexPolygon::area() const {
  if (corners_.empty()) return 0;
  double twice = 0;
  PlanePoint p = corners_.back();
  for (const PlanePoint q : corners_) {
    twice += cross(p, q);
    p = q;
  }
  return twice / 2;
}

RoundedArea area_within(const ConvexPolygon& polygon, std::span<const Circle> discs) {
  RoundedArea result;
  const auto corners = polygon.corners();
  if (corners.empty()) return result;
  // Green: half the integral of x dz - z dx along the boundary, edges first.
  PlanePoint p = corners.back();
  for (const PlanePoint q : corners) {
    LinePart part;
    for (const Circle& disc : discs) {
      const LinePart inside = within_disc(p, q, disc);
      part = {std::max(part.begin, inside.begin), std::min(part.end, inside.end)};
    }
    if (!part.empty()) result.area += (part.end - part.begin) * cross(p, q) / 2;
    p = q;
  }
  const double tolerance = 1e-13 * polygon.largest_distance_squared();
  std::vector<double> angles;
  for (std::size_t c = 0; c < discs.size(); ++c) {
    const Circle& circle = discs[c];
    angles.clear();
    add_crossings(circle, corners, discs, angles);
    if (angles.empty()) angles.push_back(0);
    std::sort(angles.begin(), angles.end());
    for (std::size_t a = 0; a < angles.size(); ++a) {
      const double begin = angles[a];
      const double end = a + 1 < angles.size() ? angles[a + 1] : angles.front() + 2 * std::numbers::pi;
      const double turn = end - begin;
      // Between two crossings an arc is inside or outside as a whole.
      const PlanePoint middle = point_on(circle, begin + turn / 2);
      bool inside = holds(corners, middle, tolerance);
      for (std::size_t o = 0; o < discs.size(); ++o) inside = inside && (o == c || holds(discs[o], middle));
      if (!inside) continue;
      // Chord and segment apart: of a large circle only a small turn counts.
      result.area += cross(point_on(circle, begin), point_on(circle, end)) / 2 +
                     circle.radius * circle.radius / 2 * (turn - std::sin(turn));
      if (c == 0) result.length_on_first += circle.radius * turn;
    }
  }
  return result;
}

}  // namespace drumlin::particles
