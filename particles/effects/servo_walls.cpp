#include "particles/effects/servo_walls.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin::particles {
namespace {

Point unit_vector(const std::array<double, 2>& direction) {
  const double length = std::hypot(direction[0], direction[1]);
  return {direction[0] / length, direction[1] / length};
}

int wall_named(const Walls& walls, const std::string& name) {
  return static_cast<int>(std::find(walls.names.begin(), walls.names.end(), name) - walls.names.begin());
}

}  // namespace

double length_across(const Walls& walls, int wall, Point direction) {
  const Rigid pose(walls.pose_at_start[wall]);
  double length = 0;
  for (std::size_t s = 0; s < walls.reference.size(); ++s) {
    const auto* segment = std::get_if<Segment>(&walls.reference[s]);
    if (walls.wall_of_shape[s] != wall || !segment) continue;
    const Point along = pose.turned({segment->to.x - segment->from.x, segment->to.z - segment->from.z});
    length += std::abs(along.x * direction.z - along.z * direction.x);
  }
  return walls.period > 0 ? std::min(length, walls.period) : length;
}

Driven pressed_law(const PressureControl& key, const Walls& walls, int wall, const Scales& scales,
                   int state) {
  const double per_length = key.pressure_n_m2 * scales.length_m;  // N/m on a length of one unit
  Driven law = driven_law({key.direction, per_length, key.mass_kg_m, key.velocity_mm_s}, scales, state);
  if (key.between)
    law.between = {first_shape(walls, wall_named(walls, (*key.between)[0])),
                   first_shape(walls, wall_named(walls, (*key.between)[1]))};
  else
    law.force *= length_across(walls, wall, law.direction);
  return law;
}

Straining straining_law(const StrainRate& key, const Walls& walls, int wall, const Scales& scales) {
  const double unit = 1e-3 / scales.length_m;
  const Point e = unit_vector(key.direction);
  const Point now = moved(walls.pose_at_start[wall], middle_of(walls.reference[first_shape(walls, wall)]));
  const double distance =
      (now.x - key.reference_mm[0] * unit) * e.x + (now.z - key.reference_mm[1] * unit) * e.z;
  return {e, distance, key.rate_per_s * scales.time_s};
}

}  // namespace drumlin::particles
