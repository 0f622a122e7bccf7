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
Point impulses(const Point& halfway, const Point& end, double u_n, double u_t, double mu, double spin) {
  const double c = dot(halfway, end);     // n . n = t . t
  const double s = across(halfway, end);  // t halfway . n at the end = - n halfway . t
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
  const Point v = velocity(bodies, i), free = velocity(step.free, i);
  const bool spins = !bodies.spin.empty();
  const double rim = spins ? bodies.radius[i] * bodies.spin[i] : 0;
  const PairPath path(step, pair, v, {});
  const Surfaces start = path.at(0);
  if (!(std::abs(start.gap) < near)) return std::nullopt;
  const Point carried = v - path.velocity(0);  // of the wall's shape
  Candidate surface = pair;
  const bool container = std::holds_alternative<Container>(step.walls.before[-1 - pair.j]);
  Point end = path.displacement(h);  // against the wall
  LoneStep lone;
  for (int k = 0; k < iterations; ++k) {
    const Surfaces there = path.at_displacement(end), halfway = path.at_displacement(0.5 * end);
    const Point n = there.normal;
    if (!(dot(n, start.normal) > sharpest)) return std::nullopt;
    if (container) turn_wall_velocity(n, carried, surface);
    const double u_n = dot(n, free - carried), u_t = across(n, free - wall_velocity(surface)) - rim;
    const Point p = impulses(halfway.normal, n, u_n, u_t, mu, spins ? surface_gain : 0);
    if (!(p.x > 0)) {  // it leaves the wall, or hits an end from the side
      if (there.gap < -near) return std::nullopt;
      return LoneStep{};
    }
    lone.n = halfway.normal, lone.normal = p.x, lone.tangential = p.z;
    const Point after{free.x + lone.n.x * p.x + lone.n.z * p.z, free.z + lone.n.z * p.x - lone.n.x * p.z};
    end = h * (0.5 * (v + after) - carried);
    const Surfaces reached = path.at_displacement(end);
    if (!(std::abs(reached.gap) < near)) return std::nullopt;
    end -= reached.gap * reached.normal;  // of third order in h
  }
  if (container) turn_wall_velocity(lone.n, carried, surface);
  lone.wall_velocity = wall_velocity(surface);
  lone.end = position(bodies, i) + shift(step.free, i) + end + h * carried;
  return lone;
}

}  // namespace drumlin::particles
