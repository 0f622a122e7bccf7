#include "particles/scene/longest_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "particles/scene/scene_walls.hpp"
#include "particles/scene/validate_stages.hpp"

namespace drumlin::particles {
namespace {

using Faults = std::vector<SceneFault>;
using Vector = std::array<double, 2>;

/// g h^2 of a grain that gravity lets fall from rest.
void check_fall(const Scene& scene, std::size_t s, double smallest_mm, Faults& faults) {
  if (!scene.effects.gravity) return;
  const double g = strongest_gravity(scene, s), h = scene.stages[s].time_step_s;
  const double longest = std::sqrt(longest_fall * 1e-3 * smallest_mm / g);
  if (!(h > longest)) return;
  const std::string key = stage_key(s) + ".time_step_s";
  faults.push_back({key,
                    fmt::format("is {}, in which a grain falls by {:.3g} of the smallest diameters", h,
                                longest_fall * h * h / (longest * longest)),
                    fmt::format("up to {:.3g} s, for at most one", longest),
                    {key, "grains", "sources", "effects.gravity"}});
}

/// In the first stage: later a gas may have cooled.
void check_flight(const Scene& scene, double smallest_mm, Faults& faults) {
  if (!scene.grains.thermal_speed_mm_s || scene.stages.empty()) return;
  const double h = scene.stages[0].time_step_s;
  const double longest = longest_fall * smallest_mm / *scene.grains.thermal_speed_mm_s;
  if (!(h > longest)) return;
  const std::string key = stage_key(0) + ".time_step_s";
  faults.push_back({key,
                    fmt::format("is {}, in which a grain flies by {:.3g} of the smallest diameters", h,
                                longest_fall * h / longest),
                    fmt::format("up to {:.3g} s, for at most one", longest),
                    {key, "grains", "sources"}});
}

/// Of the first shape of a wall.
Point_mm middle_mm(const Wall& wall) {
  const auto middle = [](const SegmentShape& s) {
    return Point_mm{(s.from_mm[0] + s.to_mm[0]) / 2, (s.from_mm[1] + s.to_mm[1]) / 2};
  };
  if (const auto* s = std::get_if<SegmentShape>(&wall.shape)) return middle(*s);
  if (const auto* c = std::get_if<ContainerShape>(&wall.shape)) return c->center_mm;
  if (const auto* a = std::get_if<ArcShape>(&wall.shape)) return a->center_mm;
  if (const auto* d = std::get_if<DiscShape>(&wall.shape)) return d->center_mm;
  const auto segments = segments_of(std::get<PolylineShape>(wall.shape));
  return segments.empty() ? Point_mm{0, 0} : middle(segments.front());
}

/// The fastest velocity of a motion: that of a point, and a rotation, positive clockwise, about it.
struct Fastest {
  const char* key = "";  ///< of the motion, which sets it
  Vector velocity_mm_s{0, 0};
  double spin_per_s = 0;
  Point_mm center_mm{0, 0};
};

Fastest fastest_of(const WallMotion& wall_motion, const Wall& wall) {
  const double turn = 2 * std::numbers::pi;
  if (const auto* r = std::get_if<Rotation>(&wall_motion.motion))
    return {"speed_rpm", {}, turn / 60 * r->speed_rpm, r->center_mm};
  if (const auto* r = std::get_if<Rocking>(&wall_motion.motion))
    return {"amplitude_deg",
            {},
            turn * r->frequency_hz * r->amplitude_deg * std::numbers::pi / 180,
            r->center_mm};
  if (const auto* t = std::get_if<Translation>(&wall_motion.motion))
    return {"velocity_mm_s", t->velocity_mm_s};
  if (const auto* o = std::get_if<Oscillation>(&wall_motion.motion))
    return {"amplitude_mm",
            {turn * o->frequency_hz * o->amplitude_mm[0], turn * o->frequency_hz * o->amplitude_mm[1]}};
  if (const auto* f = std::get_if<ForceControl>(&wall_motion.motion))
    return {"velocity_mm_s", f->velocity_mm_s};
  if (const auto* p = std::get_if<PressureControl>(&wall_motion.motion))
    return {"velocity_mm_s", p->velocity_mm_s};
  if (std::holds_alternative<Belt>(wall_motion.motion)) return {"speed_mm_s", {}};  // its shape rests
  const auto& strain = std::get<StrainRate>(wall_motion.motion);
  const auto& e = strain.direction;
  const Point_mm middle = middle_mm(wall);
  const double along =
      ((middle[0] - strain.reference_mm[0]) * e[0] + (middle[1] - strain.reference_mm[1]) * e[1]) /
      (e[0] * e[0] + e[1] * e[1]);
  return {"rate_per_s", {strain.rate_per_s * along * e[0], strain.rate_per_s * along * e[1]}};
}

Vector velocity_at(const Fastest& motion, const Point_mm& p) {
  return {motion.velocity_mm_s[0] + motion.spin_per_s * (p[1] - motion.center_mm[1]),
          motion.velocity_mm_s[1] - motion.spin_per_s * (p[0] - motion.center_mm[0])};
}

double speed_at(const Fastest& motion, const Point_mm& p) {
  const Vector v = velocity_at(motion, p);
  return std::hypot(v[0], v[1]);
}

/// Of a segment across itself: fastest at one of its ends.
double speed_across(const Fastest& motion, const SegmentShape& s) {
  const double x = s.to_mm[0] - s.from_mm[0], z = s.to_mm[1] - s.from_mm[1], length = std::hypot(x, z);
  const auto across = [&](const Point_mm& p) {
    const Vector v = velocity_at(motion, p);
    return std::abs(v[1] * x - v[0] * z) / length;
  };
  return std::max(across(s.from_mm), across(s.to_mm));
}

/// Of a wall across itself. Circles turn about their centre within themselves; discs that are glued to a wall
/// move across themselves however it moves.
double speed_across(const Fastest& motion, const Wall& wall) {
  if (const auto* s = std::get_if<SegmentShape>(&wall.shape))
    return wall.rough ? std::max(speed_at(motion, s->from_mm), speed_at(motion, s->to_mm))
                      : speed_across(motion, *s);
  if (const auto* line = std::get_if<PolylineShape>(&wall.shape)) {
    double speed = 0;
    for (const SegmentShape& s : segments_of(*line)) speed = std::max(speed, speed_across(motion, s));
    return speed;
  }
  if (const auto* c = std::get_if<ContainerShape>(&wall.shape))
    return speed_at(motion, c->center_mm) + (wall.rough ? std::abs(motion.spin_per_s) * c->radius_mm : 0);
  if (const auto* a = std::get_if<ArcShape>(&wall.shape)) return speed_at(motion, a->center_mm);
  return speed_at(motion, std::get<DiscShape>(wall.shape).center_mm);
}

/// Whether stages before have brought a wall where its shape alone does not tell how fast it moves.
bool stands_elsewhere(const Scene& scene, std::size_t stage, const WallMotion& wall_motion) {
  const auto turns = [](const WallMotion& m) {
    return std::holds_alternative<Rotation>(m.motion) || std::holds_alternative<Rocking>(m.motion);
  };
  const bool by_place = turns(wall_motion) || std::holds_alternative<StrainRate>(wall_motion.motion);
  for (std::size_t s = 0; s < stage; ++s)
    for (const WallMotion& before : scene.stages[s].motions)
      if (before.wall == wall_motion.wall && (by_place || turns(before))) return true;
  return false;
}

/// What this cannot know shows in the run (LostGrain::How::pushed_too_far).
void check_walls(const Scene& scene, std::size_t s, double smallest_mm, Faults& faults) {
  const double h = scene.stages[s].time_step_s, longest = longest_push * smallest_mm;
  for (std::size_t m = 0; m < scene.stages[s].motions.size(); ++m) {
    const WallMotion& wall_motion = scene.stages[s].motions[m];
    if (stands_elsewhere(scene, s, wall_motion)) continue;
    for (const Wall& wall : scene.walls) {
      if (wall.name != wall_motion.wall) continue;
      const Fastest motion = fastest_of(wall_motion, wall);
      const double way = speed_across(motion, wall) * h;
      if (!(way > longest * (1 + relative_rounding))) continue;
      const std::string key = fmt::format("{}.motions.{}", stage_key(s), m);
      faults.push_back({key + "." + motion.key,
                        fmt::format("moves wall \"{}\" by {:.3g} mm in a step of {} s", wall.name, way, h),
                        fmt::format("up to {:.3g} mm, the smallest radius of a grain", longest),
                        {key, stage_key(s) + ".time_step_s", "grains", "walls"}});
      break;
    }
  }
}

void check_cell(const Scene& scene, std::size_t s, Faults& faults) {
  const auto& cell = scene.stages[s].cell;
  if (!cell) return;
  const double h = scene.stages[s].time_step_s;
  const auto check = [&](const std::string& key, std::optional<double> rate_per_s) {
    if (!rate_per_s || !(std::abs(*rate_per_s) * h > longest_strain * (1 + relative_rounding))) return;
    faults.push_back(
        {stage_key(s) + ".cell." + key,
         fmt::format("is {}, a strain of {:.3g} in a step of {} s", *rate_per_s, std::abs(*rate_per_s) * h,
                     h),
         fmt::format("up to {:.3g}, for a strain of at most {}", longest_strain / h, longest_strain),
         {stage_key(s) + ".cell", stage_key(s) + ".time_step_s"}});
  };
  check("shear_rate_per_s", cell->shear_rate_per_s);
  if (cell->xx) check("xx.rate_per_s", cell->xx->rate_per_s);
  if (cell->zz) check("zz.rate_per_s", cell->zz->rate_per_s);
}

}  // namespace

double smallest_made_mm(const Scene& scene) {
  double smallest = std::numeric_limits<double>::infinity();
  const auto look_at = [&](const auto& source) {
    if (const auto* made = std::get_if<GeneratedGrains>(&source))
      smallest = std::min(smallest, made->diameter_min_mm);
  };
  look_at(scene.grains.source);
  for (const GrainGroup& group : scene.grains.groups) look_at(group.source);
  for (const Source& source : scene.sources) smallest = std::min(smallest, source.diameter_min_mm);
  return smallest;
}

std::vector<SceneFault> steps_too_long(const Scene& scene, double smallest_mm) {
  Faults faults;
  check_flight(scene, smallest_mm, faults);
  for (std::size_t s = 0; s < scene.stages.size(); ++s) {
    // One longer than its stage is refused for that alone.
    if (!(scene.stages[s].time_step_s <= duration_s(scene.stages[s]))) continue;
    check_fall(scene, s, smallest_mm, faults);
    check_walls(scene, s, smallest_mm, faults);
    check_cell(scene, s, faults);
  }
  return faults;
}

}  // namespace drumlin::particles
