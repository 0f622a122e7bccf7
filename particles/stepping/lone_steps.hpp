#pragma once
// The phase of a step that replaces the impulses on grains that touch nothing but a wall by those of the
// midpoint rule (lone_contact.hpp).
#include <cmath>

#include "particles/stepping/lone_contact.hpp"
#include "particles/stepping/step_state.hpp"

namespace drumlin::particles {

/// Of grains that did in the last step, too (memory), where neither an attraction nor a couple acts there.
template <class Problem>
void take_lone_steps(const StepInput& step, const ImpulseCache& memory, StepState<Problem>& s) {
  // Of the impulse on a grain: what may come from other contacts if it counts as the only one.
  constexpr double alone = 1e-9;
  constexpr int dim = Problem::dim;
  s.lone.clear();
  auto& impulses = s.solution.impulses;
  for (std::size_t a = 0; a < s.contacts.pairs.size(); ++a) {
    Candidate& pair = s.contacts.pairs[a];
    auto [r_n, r_t, couple] = parts_of<Problem>(impulses, a);
    if (s.problem.W.j[a] != s.problem.W.fixed() || r_n == 0 || s.beside[pair.i]) continue;
    double mu = 0;
    if constexpr (dim >= 2) {
      const auto coefficients = s.problem.coefficients(static_cast<int>(a));
      if (dim == 3 && coefficients.back() > 0) continue;
      mu = coefficients[0];
    }
    if (s.contacts.attraction_of(a) > 0) continue;
    const double w = step.inverse_mass()[pair.i];
    auto& change = s.solution.velocities.bodies[pair.i];
    const Point other = Point{change.x, change.z} - w * with_parts(normal(pair), r_n, r_t);
    if (std::hypot(other.x, other.z) > alone * w * r_n || !was_loaded(memory, pair)) continue;
    auto lone = lone_step(step, pair, mu);
    if (!lone) continue;
    if (const double sliding = step.sliding_friction(mu, pair);
        sliding < mu && std::abs(lone->tangential) >= (1 - 1e-6) * mu * lone->normal)
      lone = lone_step(step, pair, sliding);
    if (!lone) continue;
    r_n = lone->normal / w, r_t = lone->tangential / w;
    impulses[dim * a] = r_n;
    if constexpr (dim >= 2) impulses[dim * a + 1] = r_t;
    if (r_n > 0) {
      set_normal(pair, lone->n), set_wall_velocity(pair, lone->wall_velocity);
    }
    const Point of_wall = w * with_parts(normal(pair), r_n, r_t);
    change.x = of_wall.x, change.z = of_wall.z;
    if constexpr (StepState<Problem>::spin) change.s = -surface_gain * w * r_t;
    if (r_n > 0) s.lone.push_back({pair.i, lone->end});
  }
}

}  // namespace drumlin::particles
