#include "particles/bodies/walls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drumlin {
namespace {

Point point_of(const Point_mm& p, const Scales& scales) {
  return {p[0] * 1e-3 / scales.length_m, p[1] * 1e-3 / scales.length_m};
}

Shape shape_of(const Wall& wall, const Scales& scales) {
  const double unit = 1e-3 / scales.length_m;
  if (const auto* c = std::get_if<ContainerShape>(&wall.shape))
    return Container{point_of(c->center_mm, scales), c->radius_mm * unit};
  if (const auto* s = std::get_if<SegmentShape>(&wall.shape))
    return Segment{point_of(s->from_mm, scales), point_of(s->to_mm, scales)};
  const auto& d = std::get<DiscShape>(wall.shape);
  return FixedDisc{point_of(d.center_mm, scales), d.diameter_mm / 2 * unit};
}

Motion motion_of(const WallMotion& asked, const Scales& scales) {
  if (const auto* r = std::get_if<Rotation>(&asked.motion))
    return Turning{r->speed_rpm * 2 * std::numbers::pi / 60 * scales.time_s, point_of(r->center_mm, scales)};
  const auto& t = std::get<Translation>(asked.motion);
  const double unit = 1e-3 / scales.velocity_m_s();
  return Gliding{t.velocity_mm_s[0] * unit, t.velocity_mm_s[1] * unit};
}

}  // namespace

Point moved(const Pose& pose, Point p) {
  // Clockwise by `angle`: (x, z) -> (x cos + z sin, -x sin + z cos).
  const double c = std::cos(pose.angle), s = std::sin(pose.angle);
  return {c * p.x + s * p.z + pose.x, -s * p.x + c * p.z + pose.z};
}

Pose after(const Pose& second, const Pose& first) {
  const Point offset = moved(second, {first.x, first.z});
  return {first.angle + second.angle, offset.x, offset.z};
}

Pose inverse(const Pose& pose) {
  const Point offset = moved({-pose.angle, 0, 0}, {-pose.x, -pose.z});
  return {-pose.angle, offset.x, offset.z};
}

Pose displacement(const Motion& motion, double time) {
  if (const auto* turning = std::get_if<Turning>(&motion)) {
    const double angle = turning->spin * time;
    const Point turned = moved({angle, 0, 0}, turning->center);
    return {angle, turning->center.x - turned.x, turning->center.z - turned.z};
  }
  if (const auto* gliding = std::get_if<Gliding>(&motion))
    return {0, gliding->v_x * time, gliding->v_z * time};
  return {};
}

Shape moved(const Pose& pose, const Shape& shape) {
  if (const auto* c = std::get_if<Container>(&shape)) return Container{moved(pose, c->center), c->radius};
  if (const auto* s = std::get_if<Segment>(&shape)) return Segment{moved(pose, s->from), moved(pose, s->to)};
  const auto& d = std::get<FixedDisc>(shape);
  return FixedDisc{moved(pose, d.center), d.radius};
}

Pose Walls::pose(int wall, double time_in_stage) const {
  return after(displacement(motion[wall], time_in_stage), pose_at_start[wall]);
}

std::vector<Shape> Walls::shapes_at(double time_in_stage) const {
  std::vector<Shape> shapes;
  shapes.reserve(reference.size());
  for (std::size_t s = 0; s < reference.size(); ++s)
    shapes.push_back(moved(pose(wall_of_shape[s], time_in_stage), reference[s]));
  return shapes;
}

Walls walls_of(const Scene& scene, const Scales& scales) {
  Walls walls;
  for (const Wall& wall : scene.walls) {
    auto known = std::find(walls.names.begin(), walls.names.end(), wall.name);
    if (known == walls.names.end()) known = walls.names.insert(walls.names.end(), wall.name);
    walls.wall_of_shape.push_back(static_cast<int>(known - walls.names.begin()));
    walls.reference.push_back(shape_of(wall, scales));
  }
  walls.motion.resize(walls.names.size());
  walls.pose_at_start.resize(walls.names.size());
  return walls;
}

void begin_stage(Walls& walls, const Stage& stage, const Scales& scales, double time_in_old_stage) {
  for (std::size_t w = 0; w < walls.names.size(); ++w) {
    walls.pose_at_start[w] = walls.pose(static_cast<int>(w), time_in_old_stage);
    walls.motion[w] = std::monostate{};
    for (const WallMotion& asked : stage.motions)
      if (asked.wall == walls.names[w]) walls.motion[w] = motion_of(asked, scales);
  }
}

}  // namespace drumlin
