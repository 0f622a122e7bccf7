#include "particles/stepping/lone_contact.hpp"

#include <algorithm>
#include <cmath>

#include "particles/bodies/disc_inertia.hpp"
#include "particles/contact_law/coulomb_coupled.hpp"
#include "particles/stepping/meeting.hpp"

namespace drumlin::particles {
namespace {

// Further from the surface, in d, or around a sharper corner, in the cosine of the angle, the step is left to
// the implicit rule.
constexpr double near = 1e-2, sharpest = 0.9;
constexpr int iterations = 4;  // of the end of the step, each of which gains an order

/// Per unit of mass: the impulses along the normal halfway and its tangent that leave no velocity `u` across
/// the wall at the end, and no sliding u_t there if friction mu suffices. `spin`: surface_gain where friction
/// turns the disc, else 0.
Point impulses(const Surfaces& halfway, const Surfaces& end, double u_n, double u_t, double mu, double spin) {
  const double c = halfway.n_x * end.n_x + halfway.n_z * end.n_z;  // n . n = t . t
  const double s =
      halfway.n_z * end.n_x - halfway.n_x * end.n_z;  // t halfway . n at the end = - n halfway . t
  Eigen::Matrix2d W;
  W << c, s, -s, c + spin;
  const Eigen::Vector2d p = solve_planar_contact(W, {u_n, u_t}, mu);
  return {p[0], p[1]};
}

}  // namespace

std::optional<LoneStep> lone_step(const StepInput& step, const Candidate& pair, double mu) {
  const double h = step.time_step;
  const Bodies& bodies = step.bodies;
  const std::int32_t i = pair.i;
  const Point v{bodies.v_x[i], bodies.v_z[i]}, free{step.free.x[i], step.free.z[i]};
  const bool spins = !bodies.spin.empty();
  const double rim = spins ? bodies.radius[i] * bodies.spin[i] : 0;
  const PairPath path(step, pair, v, {});
  const Surfaces start = path.at(0);
  if (!(std::abs(start.gap) < near)) return std::nullopt;
  const Point u = path.velocity(0), carried{v.x - u.x, v.z - u.z};  // of the wall's shape
  Candidate surface = pair;
  const bool container = std::holds_alternative<Container>(step.walls.before[-1 - pair.j]);
  Point end = path.displacement(h);  // against the wall
  LoneStep lone;
  for (int k = 0; k < iterations; ++k) {
    const Surfaces there = path.at_displacement(end), halfway = path.at_displacement({end.x / 2, end.z / 2});
    if (!(there.n_x * start.n_x + there.n_z * start.n_z > sharpest)) return std::nullopt;
    if (container) turn_wall_velocity(there, carried, surface);
    const Point wall{surface.wall_v_x, surface.wall_v_z};
    const double u_n = there.n_x * (free.x - carried.x) + there.n_z * (free.z - carried.z);
    const double u_t = there.n_z * (free.x - wall.x) - there.n_x * (free.z - wall.z) - rim;
    const Point p = impulses(halfway, there, u_n, u_t, mu, spins ? surface_gain : 0);
    if (!(p.x > 0)) {  // it leaves the wall, or hits an end from the side
      if (there.gap < -near) return std::nullopt;
      return LoneStep{};
    }
    lone.n_x = halfway.n_x, lone.n_z = halfway.n_z, lone.normal = p.x, lone.tangential = p.z;
    const Point after{free.x + lone.n_x * p.x + lone.n_z * p.z, free.z + lone.n_z * p.x - lone.n_x * p.z};
    end = {h * ((v.x + after.x) / 2 - carried.x), h * ((v.z + after.z) / 2 - carried.z)};
    const Surfaces reached = path.at_displacement(end);
    if (!(std::abs(reached.gap) < near)) return std::nullopt;
    end.x -= reached.gap * reached.n_x, end.z -= reached.gap * reached.n_z;  // of third order in h
  }
  if (container) turn_wall_velocity({0, lone.n_x, lone.n_z}, carried, surface);
  lone.wall_velocity = {surface.wall_v_x, surface.wall_v_z};
  const PathShift shift = step.free.shift.empty() ? PathShift{} : step.free.shift[i];
  lone.end = {bodies.x[i] + shift.x + end.x + h * carried.x, bodies.z[i] + shift.z + end.z + h * carried.z};
  return lone;
}

}  // namespace drumlin::particles
