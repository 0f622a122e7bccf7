#include "particles/bodies/walls.hpp"

#include <algorithm>
#include <cmath>

#include "particles/bodies/arc.hpp"

namespace drumlin::particles {
Rigid::Rigid(const Pose& pose)
    : cosine(std::cos(pose.angle)), sine(std::sin(pose.angle)), x(pose.x), z(pose.z) {}

// Clockwise by the angle: (x, z) -> (x cos + z sin, -x sin + z cos).
Point Rigid::moved(Point p) const { return {cosine * p.x + sine * p.z + x, -sine * p.x + cosine * p.z + z}; }

Point Rigid::turned(Point p) const { return {cosine * p.x + sine * p.z, -sine * p.x + cosine * p.z}; }

Point moved(const Pose& pose, Point p) { return Rigid(pose).moved(p); }

Pose after(const Pose& second, const Pose& first) {
  const Point offset = moved(second, {first.x, first.z});
  return {first.angle + second.angle, offset.x, offset.z};
}

Pose inverse(const Pose& pose) {
  const Point offset = moved({-pose.angle, 0, 0}, {-pose.x, -pose.z});
  return {-pose.angle, offset.x, offset.z};
}

Pose displacement(const Motion& motion, double time, std::span<const DrivenState> driven_states) {
  const auto turned_about = [](double angle, const Point& center) {
    const Point turned = moved({angle, 0, 0}, center);
    return Pose{angle, center.x - turned.x, center.z - turned.z};
  };
  const auto swing = [time](const auto& m) { return std::sin(m.rate * time + m.phase) - std::sin(m.phase); };
  if (const auto* turning = std::get_if<Turning>(&motion))
    return turned_about(turning->spin * time, turning->center);
  if (const auto* gliding = std::get_if<Gliding>(&motion))
    return {0, gliding->v_x * time, gliding->v_z * time};
  if (const auto* shaking = std::get_if<Shaking>(&motion))
    return {0, shaking->amplitude.x * swing(*shaking), shaking->amplitude.z * swing(*shaking)};
  if (const auto* swinging = std::get_if<Swinging>(&motion))
    return turned_about(swinging->amplitude * swing(*swinging), swinging->center);
  if (const auto* driven = std::get_if<Driven>(&motion)) {
    const double position = driven_states[driven->state].position;
    return {0, position * driven->direction.x + driven->glide_x * time,
            position * driven->direction.z + driven->glide_z * time};
  }
  if (const auto* straining = std::get_if<Straining>(&motion)) {
    const double displacement = straining->distance * std::expm1(straining->rate * time);
    return {0, displacement * straining->direction.x, displacement * straining->direction.z};
  }
  return {};
}

Shape moved(const Rigid& pose, const Shape& shape) {
  if (const auto* c = std::get_if<Container>(&shape)) return Container{pose.moved(c->center), c->radius};
  if (const auto* s = std::get_if<Segment>(&shape))
    return Segment{pose.moved(s->from), pose.moved(s->to), pose.turned(s->beyond_from),
                   pose.turned(s->beyond_to)};
  if (is_open(shape)) return shape;
  if (const auto* a = std::get_if<Arc>(&shape))
    return Arc{pose.moved(a->center), a->radius, pose.turned(a->joint), a->turn, pose.turned(a->beyond)};
  const auto& d = std::get<FixedDisc>(shape);
  return FixedDisc{pose.moved(d.center), d.radius};
}

namespace {

/// An end of a thin wall: where it is, the direction from there along the wall, and what is to learn of
/// another end that meets it.
struct JoinedEnd {
  Point place, along;
  int together;
  Point* beyond;
};

std::vector<JoinedEnd> thin_ends(std::span<Shape> shapes, std::span<const int> together) {
  std::vector<JoinedEnd> ends;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    if (auto* s = std::get_if<Segment>(&shapes[k])) {
      const double x = s->to.x - s->from.x, z = s->to.z - s->from.z, length = std::hypot(x, z);
      ends.push_back({s->from, {x / length, z / length}, together[k], &s->beyond_from});
      ends.push_back({s->to, {-x / length, -z / length}, together[k], &s->beyond_to});
    }
    if (auto* a = std::get_if<Arc>(&shapes[k]))
      ends.push_back({at(*a, a->turn), tangent_at_end(*a), together[k], &a->beyond});
  }
  return ends;
}

}  // namespace

void join_ends(std::span<Shape> shapes, std::span<const int> together) {
  constexpr double near = 1e-6;  // d
  std::vector<JoinedEnd> ends = thin_ends(shapes, together);
  std::sort(ends.begin(), ends.end(), [](const auto& a, const auto& b) { return a.place.x < b.place.x; });
  for (std::size_t a = 0; a < ends.size(); ++a)
    for (std::size_t b = a + 1; b < ends.size() && ends[b].place.x - ends[a].place.x < near; ++b)
      if (std::abs(ends[b].place.z - ends[a].place.z) < near && ends[a].together == ends[b].together)
        *ends[a].beyond = ends[b].along, *ends[b].beyond = ends[a].along;
}

Point middle_of(const Shape& shape) {
  if (const auto* s = std::get_if<Segment>(&shape))
    return {(s->from.x + s->to.x) / 2, (s->from.z + s->to.z) / 2};
  if (const auto* d = std::get_if<FixedDisc>(&shape)) return d->center;
  if (const auto* a = std::get_if<Arc>(&shape)) return at(*a, 0);
  const auto* c = std::get_if<Container>(&shape);
  return c ? c->center : Point{};
}

std::optional<Reaches> reaches_of(const Shape& shape) {
  if (const auto* s = std::get_if<Segment>(&shape))
    return Reaches{std::min(s->from.x, s->to.x), std::max(s->from.x, s->to.x), std::min(s->from.z, s->to.z),
                   std::max(s->from.z, s->to.z)};
  if (const auto* d = std::get_if<FixedDisc>(&shape))
    return Reaches{d->center.x - d->radius, d->center.x + d->radius, d->center.z - d->radius,
                   d->center.z + d->radius};
  if (const auto* a = std::get_if<Arc>(&shape)) return reaches_of(*a);
  return std::nullopt;
}

double largest_move(const Shape& shape, const Pose& displacement) {
  const Rigid rigid(displacement);
  const auto move_of = [&rigid](Point p) {
    const Point then = rigid.moved(p);
    const double x = then.x - p.x, z = then.z - p.z;
    return std::sqrt(x * x + z * z);
  };
  const auto round = [&](const auto& s) {
    return move_of(s.center) + std::abs(displacement.angle) * s.radius;
  };
  if (const auto* s = std::get_if<Segment>(&shape)) return std::max(move_of(s->from), move_of(s->to));
  if (const auto* c = std::get_if<Container>(&shape)) return round(*c);
  if (const auto* d = std::get_if<FixedDisc>(&shape)) return round(*d);
  if (const auto* a = std::get_if<Arc>(&shape)) return round(*a);
  return 0;
}

int first_shape(const Walls& walls, int wall) {
  return static_cast<int>(std::find(walls.wall_of_shape.begin(), walls.wall_of_shape.end(), wall) -
                          walls.wall_of_shape.begin());
}

const Driven* driven_motion(const Walls& walls, std::size_t wall) {
  const auto& motions = walls.motions[wall];
  return motions.empty() ? nullptr : std::get_if<Driven>(&motions.back());
}

Pose Walls::pose(int wall, double time_in_stage, std::span<const DrivenState> driven) const {
  Pose pose = pose_at_start[wall];
  for (const Motion& motion : motions[wall]) pose = after(displacement(motion, time_in_stage, driven), pose);
  return pose;
}

std::vector<Shape> Walls::shapes_at(double time_in_stage, std::span<const DrivenState> driven) const {
  std::vector<Rigid> poses;
  for (std::size_t w = 0; w < names.size(); ++w)
    poses.emplace_back(pose(static_cast<int>(w), time_in_stage, driven));
  std::vector<Shape> shapes;
  shapes.reserve(reference.size());
  for (std::size_t s = 0; s < reference.size(); ++s)
    if (!open.empty() && open[wall_of_shape[s]])
      shapes.emplace_back(Opened{});
    else
      shapes.push_back(moved(poses[wall_of_shape[s]], reference[s]));
  return shapes;
}

}  // namespace drumlin::particles
