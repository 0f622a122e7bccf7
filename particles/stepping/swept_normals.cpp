#include "particles/stepping/swept_normals.hpp"

#include <algorithm>
#include <cmath>

namespace drumlin::particles {
namespace {

constexpr double fast = 0.25;  // d per step

/// Sum of the radii of a pair of discs; 0 for other pairs.
double reach_of(const StepInput& step, const Candidate& pair) {
  const double radius = step.bodies.radius[pair.i];
  if (pair.j >= 0) return radius + step.bodies.radius[pair.j];
  const auto* disc = std::get_if<FixedDisc>(&step.walls.before[-1 - pair.j]);
  return disc ? radius + disc->radius : 0;
}

/// Share of the way m after which a centre at c is at the distance `reach` from the origin, or nearest to it.
double share_of_way(const Point& c, const Point& m, double reach) {
  const double along = c.x * m.x + c.z * m.z, way = m.x * m.x + m.z * m.z;
  const double over = c.x * c.x + c.z * c.z - reach * reach;
  const double root = along * along - way * over;
  const double share = root > 0 && along < 0 ? (-along - std::sqrt(root)) / way : -along / way;
  return std::clamp(share, 0.0, 1.0);
}

}  // namespace

void sweep_normals(const StepInput& step, std::span<Candidate> pairs) {
  const double h = step.time_step;
  for (Candidate& pair : pairs) {
    Point m{step.free.x[pair.i], step.free.z[pair.i]};
    m.x -= pair.wall_v_x, m.z -= pair.wall_v_z;
    if (pair.j >= 0) m.x -= step.free.x[pair.j], m.z -= step.free.z[pair.j];
    m.x *= h, m.z *= h;
    if (m.x * m.x + m.z * m.z <= fast * fast || pair.gap <= 0) continue;
    const double reach = reach_of(step, pair);
    if (reach <= 0) continue;
    const Point c{pair.n_x * (reach + pair.gap), pair.n_z * (reach + pair.gap)};
    const double share = share_of_way(c, m, reach);
    const double x = c.x + share * m.x, z = c.z + share * m.z, distance = std::hypot(x, z);
    if (distance <= 0) continue;
    pair.n_x = x / distance, pair.n_z = z / distance;
    pair.gap = c.x * pair.n_x + c.z * pair.n_z - reach;
  }
}

}  // namespace drumlin::particles
