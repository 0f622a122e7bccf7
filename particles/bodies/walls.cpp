#include "particles/bodies/walls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "particles/scene/materials.hpp"

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
  const double radian = std::numbers::pi / 180;
  if (const auto* o = std::get_if<Oscillation>(&asked.motion))
    return Shaking{point_of(o->amplitude_mm, scales), 2 * std::numbers::pi * o->frequency_hz * scales.time_s,
                   o->phase_deg * radian};
  if (const auto* r = std::get_if<Rocking>(&asked.motion))
    return Swinging{r->amplitude_deg * radian, 2 * std::numbers::pi * r->frequency_hz * scales.time_s,
                    r->phase_deg * radian, point_of(r->center_mm, scales)};
  const double unit = 1e-3 / scales.velocity_m_s();
  if (const auto* f = std::get_if<ForceControl>(&asked.motion)) {
    const double length = std::hypot(f->direction[0], f->direction[1]);
    const double mass = scales.density_kg_m3 * scales.length_m * scales.length_m;
    const double force = mass * scales.length_m / (scales.time_s * scales.time_s);
    return Driven{{f->direction[0] / length, f->direction[1] / length},
                  f->force_n_m / force,
                  mass / f->mass_kg_m,
                  f->velocity_mm_s[0] * unit,
                  f->velocity_mm_s[1] * unit};
  }
  const auto& t = std::get<Translation>(asked.motion);
  return Gliding{t.velocity_mm_s[0] * unit, t.velocity_mm_s[1] * unit};
}

}  // namespace

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

Pose displacement(const Motion& motion, double time) {
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
  if (const auto* driven = std::get_if<Driven>(&motion))
    return {0, driven->position * driven->direction.x + driven->glide_x * time,
            driven->position * driven->direction.z + driven->glide_z * time};
  return {};
}

Shape moved(const Rigid& pose, const Shape& shape) {
  if (const auto* c = std::get_if<Container>(&shape)) return Container{pose.moved(c->center), c->radius};
  if (const auto* s = std::get_if<Segment>(&shape)) return Segment{pose.moved(s->from), pose.moved(s->to)};
  const auto& d = std::get<FixedDisc>(shape);
  return FixedDisc{pose.moved(d.center), d.radius};
}

Pose Walls::pose(int wall, double time_in_stage) const {
  return after(displacement(motion[wall], time_in_stage), pose_at_start[wall]);
}

std::vector<DrivenState> Walls::driven_states() const {
  std::vector<DrivenState> states;
  for (const Motion& m : motion)
    if (const auto* driven = std::get_if<Driven>(&m)) states.push_back({driven->position, driven->velocity});
  return states;
}

void Walls::set_driven_states(const std::vector<DrivenState>& states) {
  auto next = states.begin();
  for (Motion& m : motion)
    if (auto* driven = std::get_if<Driven>(&m)) {
      driven->position = next->position, driven->velocity = next->velocity;
      ++next;
    }
}

std::vector<Shape> Walls::shapes_at(double time_in_stage) const {
  std::vector<Rigid> poses;
  for (std::size_t w = 0; w < names.size(); ++w) poses.emplace_back(pose(static_cast<int>(w), time_in_stage));
  std::vector<Shape> shapes;
  shapes.reserve(reference.size());
  for (std::size_t s = 0; s < reference.size(); ++s)
    shapes.push_back(moved(poses[wall_of_shape[s]], reference[s]));
  return shapes;
}

double wall_length_mm(const Wall& wall) {
  if (const auto* c = std::get_if<ContainerShape>(&wall.shape)) return 2 * std::numbers::pi * c->radius_mm;
  if (const auto* s = std::get_if<SegmentShape>(&wall.shape))
    return std::hypot(s->to_mm[0] - s->from_mm[0], s->to_mm[1] - s->from_mm[1]);
  return 0;
}

std::vector<Point_mm> glued_centers_mm(const Wall& wall) {
  std::vector<Point_mm> centers;
  if (!wall.rough || wall_length_mm(wall) <= 0) return centers;
  // A length that is a whole number of spacings but for rounding has just as many.
  const int discs =
      static_cast<int>(std::ceil(std::min(wall_length_mm(wall) / wall.rough->spacing_mm, 1e7) * (1 - 1e-12)));
  if (const auto* c = std::get_if<ContainerShape>(&wall.shape)) {
    for (int k = 0; k < discs; ++k) {
      const double angle = 2 * std::numbers::pi * k / discs;
      centers.push_back({c->center_mm[0] + c->radius_mm * std::cos(angle),
                         c->center_mm[1] + c->radius_mm * std::sin(angle)});
    }
  } else if (const auto* s = std::get_if<SegmentShape>(&wall.shape)) {
    const double along_x = s->to_mm[0] - s->from_mm[0], along_z = s->to_mm[1] - s->from_mm[1];
    for (int k = 0; k < discs; ++k) {
      const double share = (k + 0.5) / discs;
      centers.push_back({s->from_mm[0] + share * along_x, s->from_mm[1] + share * along_z});
    }
  }
  return centers;
}

Walls walls_of(const Scene& scene, const Scales& scales) {
  Walls walls;
  const auto materials = material_names(scene);
  const bool stored = materials_matter(scene);
  for (const Wall& wall : scene.walls) {
    auto known = std::find(walls.names.begin(), walls.names.end(), wall.name);
    if (known == walls.names.end()) known = walls.names.insert(walls.names.end(), wall.name);
    walls.reference.push_back(shape_of(wall, scales));
    for (const Point_mm& center : glued_centers_mm(wall))
      walls.reference.push_back(
          FixedDisc{point_of(center, scales), wall.rough->diameter_mm / 2 * 1e-3 / scales.length_m});
    walls.wall_of_shape.resize(walls.reference.size(), static_cast<int>(known - walls.names.begin()));
    if (stored)
      walls.material_of_shape.resize(walls.reference.size(),
                                     static_cast<std::uint8_t>(material_number(materials, wall.material)));
  }
  walls.motion.resize(walls.names.size());
  walls.pose_at_start.resize(walls.names.size());
  return walls;
}

namespace {

Point straight_velocity(const Motion& motion) {
  if (const auto* gliding = std::get_if<Gliding>(&motion)) return {gliding->v_x, gliding->v_z};
  if (const auto* driven = std::get_if<Driven>(&motion))
    return {driven->velocity * driven->direction.x + driven->glide_x,
            driven->velocity * driven->direction.z + driven->glide_z};
  return {};
}

}  // namespace

void begin_stage(Walls& walls, const Stage& stage, const Scales& scales, double time_in_old_stage) {
  for (std::size_t w = 0; w < walls.names.size(); ++w) {
    walls.pose_at_start[w] = walls.pose(static_cast<int>(w), time_in_old_stage);
    const Point had = straight_velocity(walls.motion[w]);
    walls.motion[w] = std::monostate{};
    for (const WallMotion& asked : stage.motions)
      if (asked.wall == walls.names[w]) walls.motion[w] = motion_of(asked, scales);
    if (auto* driven = std::get_if<Driven>(&walls.motion[w]))
      driven->velocity = had.x * driven->direction.x + had.z * driven->direction.z;
  }
}

}  // namespace drumlin
