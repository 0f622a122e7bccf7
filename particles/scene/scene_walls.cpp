#include "particles/scene/scene_walls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "particles/bodies/arc.hpp"
#include "particles/scene/materials.hpp"
#include "particles/scene/region.hpp"

namespace drumlin::particles {
namespace {

Point point_of(const Point_mm& p, const Scales& scales) {
  return {p[0] * 1e-3 / scales.length_m, p[1] * 1e-3 / scales.length_m};
}

Segment segment_of(const SegmentShape& s, const Scales& scales) {
  return {point_of(s.from_mm, scales), point_of(s.to_mm, scales)};
}

/// Adds the shapes of a wall, without the discs glued to it.
void add_shapes(const Wall& wall, const Scales& scales, std::vector<Shape>& shapes) {
  const double unit = 1e-3 / scales.length_m;
  if (const auto* c = std::get_if<ContainerShape>(&wall.shape))
    shapes.push_back(Container{point_of(c->center_mm, scales), c->radius_mm * unit});
  if (const auto* s = std::get_if<SegmentShape>(&wall.shape)) shapes.push_back(segment_of(*s, scales));
  if (const auto* d = std::get_if<DiscShape>(&wall.shape))
    shapes.push_back(FixedDisc{point_of(d->center_mm, scales), d->diameter_mm / 2 * unit});
  if (const auto* p = std::get_if<PolylineShape>(&wall.shape))
    for (const SegmentShape& s : segments_of(*p)) shapes.push_back(segment_of(s, scales));
  if (const auto* a = std::get_if<ArcShape>(&wall.shape))
    for (const Arc& half :
         halves_of(point_of(a->center_mm, scales), a->radius_mm * unit, a->from_deg * std::numbers::pi / 180,
                   a->to_deg * std::numbers::pi / 180))
      shapes.push_back(half);
}

/// The motion of wall `wall`. `driven`: how many walls the stage drives before this one.
Motion motion_of(const WallMotion& wall_motion, const Walls& walls, int wall, const Scales& scales,
                 int driven) {
  if (const auto* r = std::get_if<Rotation>(&wall_motion.motion))
    return Turning{r->speed_rpm * 2 * std::numbers::pi / 60 * scales.time_s, point_of(r->center_mm, scales)};
  if (const auto* o = std::get_if<Oscillation>(&wall_motion.motion))
    return Shaking{point_of(o->amplitude_mm, scales), 2 * std::numbers::pi * o->frequency_hz * scales.time_s,
                   o->phase_deg * radian};
  if (const auto* r = std::get_if<Rocking>(&wall_motion.motion))
    return Swinging{r->amplitude_deg * radian, 2 * std::numbers::pi * r->frequency_hz * scales.time_s,
                    r->phase_deg * radian, point_of(r->center_mm, scales)};
  if (const auto* f = std::get_if<ForceControl>(&wall_motion.motion)) return driven_law(*f, scales, driven);
  if (const auto* p = std::get_if<PressureControl>(&wall_motion.motion))
    return pressed_law(*p, walls, wall, scales, driven);
  if (const auto* e = std::get_if<StrainRate>(&wall_motion.motion))
    return straining_law(*e, walls, wall, scales);
  const double unit = 1e-3 / scales.velocity_m_s();
  if (const auto* b = std::get_if<Belt>(&wall_motion.motion)) return Running{b->speed_mm_s * unit};
  const auto& t = std::get<Translation>(wall_motion.motion);
  return Gliding{t.velocity_mm_s[0] * unit, t.velocity_mm_s[1] * unit};
}

/// The circle of a container or a disc.
std::optional<CircleRegion> circle_of(const Wall& wall) {
  if (const auto* c = std::get_if<ContainerShape>(&wall.shape))
    return CircleRegion{c->center_mm, c->radius_mm};
  if (const auto* d = std::get_if<DiscShape>(&wall.shape))
    return CircleRegion{d->center_mm, d->diameter_mm / 2};
  return std::nullopt;
}

MaterialSet materials_met(const Wall& wall, const std::vector<std::string>& materials) {
  MaterialSet met;
  if (!wall.acts_on) return met.set();
  for (const std::string& name : *wall.acts_on) met.set(material_number(materials, name));
  return met;
}

}  // namespace

std::vector<SegmentShape> segments_of(const PolylineShape& line) {
  const std::size_t points = std::min(line.x_mm.size(), line.z_mm.size());
  std::vector<SegmentShape> segments;
  const auto point = [&line](std::size_t p) { return Point_mm{line.x_mm[p], line.z_mm[p]}; };
  for (std::size_t p = 1; p < points; ++p) segments.push_back({point(p - 1), point(p)});
  if (line.closed.value_or(false) && points > 2) segments.push_back({point(points - 1), point(0)});
  return segments;
}

double wall_length_mm(const Wall& wall) {
  if (const auto circle = circle_of(wall)) return 2 * std::numbers::pi * circle->radius_mm;
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
  if (const auto c = circle_of(wall)) {
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

namespace {

/// Joins the ends of shapes of one wall, and those of all walls that no stage moves or opens and that meet
/// all grains.
void join_ends(const Scene& scene, Walls& walls) {
  std::vector<int> together(walls.names.size(), -1);
  const auto apart = [&](const std::string& name) {
    for (std::size_t w = 0; w < walls.names.size(); ++w)
      if (walls.names[w] == name) together[w] = static_cast<int>(w);
  };
  for (const Wall& wall : scene.walls)
    if (wall.acts_on) apart(wall.name);
  for (const Stage& stage : scene.stages) {
    for (const WallMotion& motion : stage.motions)
      if (!std::holds_alternative<Belt>(motion.motion)) apart(motion.wall);
    if (stage.opens)
      for (const std::string& name : *stage.opens) apart(name);
  }
  std::vector<int> of_shape;
  for (const int wall : walls.wall_of_shape) of_shape.push_back(together[wall]);
  join_ends(walls.reference, of_shape);
}

}  // namespace

Walls walls_of(const Scene& scene, const Scales& scales) {
  Walls walls;
  const auto materials = material_names(scene);
  const bool stored = materials_matter(scene), chosen = walls_choose_materials(scene);
  for (const Wall& wall : scene.walls) {
    auto known = std::find(walls.names.begin(), walls.names.end(), wall.name);
    if (known == walls.names.end()) known = walls.names.insert(walls.names.end(), wall.name);
    add_shapes(wall, scales, walls.reference);
    for (const Point_mm& center : glued_centers_mm(wall))
      walls.reference.push_back(
          FixedDisc{point_of(center, scales), wall.rough->diameter_mm / 2 * 1e-3 / scales.length_m});
    walls.wall_of_shape.resize(walls.reference.size(), static_cast<int>(known - walls.names.begin()));
    if (stored)
      walls.material_of_shape.resize(walls.reference.size(),
                                     static_cast<std::uint8_t>(material_number(materials, wall.material)));
    if (chosen) walls.acts_on.resize(walls.reference.size(), materials_met(wall, materials));
  }
  join_ends(scene, walls);
  walls.motions.resize(walls.names.size());
  walls.pose_at_start.resize(walls.names.size());
  if (scene.periodic_x)
    walls.period = (scene.periodic_x->x_max_mm - scene.periodic_x->x_min_mm) * 1e-3 / scales.length_m;
  return walls;
}

namespace {

Point straight_velocity(const Motion& motion, std::span<const DrivenState> states) {
  if (const auto* gliding = std::get_if<Gliding>(&motion)) return {gliding->v_x, gliding->v_z};
  if (const auto* driven = std::get_if<Driven>(&motion)) {
    const double velocity = states[driven->state].velocity;
    return {velocity * driven->direction.x + driven->glide_x,
            velocity * driven->direction.z + driven->glide_z};
  }
  return {};
}

/// What motions in a line leave of a wall's velocity after the time; rotations that follow turn it.
Point straight_velocity(const std::vector<Motion>& motions, double time,
                        std::span<const DrivenState> states) {
  Point sum;
  for (const Motion& motion : motions) {
    const Point turned = Rigid(displacement(motion, time, states)).turned(sum);
    const Point own = straight_velocity(motion, states);
    sum = {turned.x + own.x, turned.z + own.z};
  }
  return sum;
}

}  // namespace

std::vector<DrivenState> begin_stage(Walls& walls, const Stage& stage, const Scales& scales,
                                     double time_in_old_stage, std::span<const DrivenState> driven) {
  std::vector<DrivenState> states;
  for (std::size_t w = 0; w < walls.names.size(); ++w) {
    walls.pose_at_start[w] = walls.pose(static_cast<int>(w), time_in_old_stage, driven);
    const Point had = straight_velocity(walls.motions[w], time_in_old_stage, driven);
    walls.motions[w].clear();
    for (const WallMotion& wall_motion : stage.motions)
      if (wall_motion.wall == walls.names[w])
        walls.motions[w].push_back(
            motion_of(wall_motion, walls, static_cast<int>(w), scales, static_cast<int>(states.size())));
    if (const Driven* now = driven_motion(walls, w))
      states.push_back({0, had.x * now->direction.x + had.z * now->direction.z});
  }
  return states;
}
}  // namespace drumlin::particles
