#pragma once
// Assembles the contact problem u = W r + q of a step: W from normals and masses, q and the cones from what
// each effect adds to a contact (particles/effects).
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "particles/contact/problems.hpp"
#include "particles/effects/driven_walls.hpp"
#include "particles/effects/friction.hpp"
#include "particles/effects/spin.hpp"
#include "particles/parallel/parallel_loops.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/stepping/cell_step.hpp"
#include "particles/stepping/step_contacts.hpp"

namespace drumlin::particles {

/// Velocity of the wall of a pair, or of the image of j against j; `of_driven(k)`: that along the direction
/// of driven wall k.
template <class OfDriven>
Point wall_velocity(const StepInput& step, const Candidate& pair, OfDriven of_driven) {
  const Point prescribed = wall_velocity(pair);
  const std::int32_t k = driven_wall_of(step.walls, pair);
  if (k < 0) return prescribed;
  const Driven& wall = step.walls.driven[k];
  // The pair has the wall's velocity by its force alone.
  return along(prescribed, wall, of_driven(k) - free_velocity(wall, step.driven[k], step.time_step));
}

/// Free velocity of i relative to j, or to the image of j that is nearest.
template <class Motion>
Point relative_velocity(const Candidate& pair, const Motion& motion, const Point& wall) {
  if (pair.j < 0) return velocity(motion, pair.i) - wall;
  return velocity(motion, pair.i) - velocity(motion, pair.j) - wall_velocity(pair);
}

/// Bodies of the problem: the grains, the fixed one that walls share, the driven walls or the cell.
template <class Problem>
void assemble_bodies(const StepInput& step, Problem& problem) {
  auto& W = problem.W;
  const auto inverse_mass = step.inverse_mass();
  W.inverse_mass.assign(inverse_mass.begin(), inverse_mass.end());
  W.inverse_mass.push_back(0);
  W.driven.clear();
  for (const Driven& wall : step.walls.driven)
    W.driven.push_back({wall.direction.x, wall.direction.z, wall.inverse_mass});
  W.inverse_mass.resize(W.inverse_mass.size() + step.walls.driven.size(), 0.0);
  W.cell.reset();
  if (step.cell.pressed()) {
    W.cell = CellBody{step.cell.inverse_inertia_x, step.cell.inverse_inertia_z, step.cell.length_x,
                      step.cell.length_z};
    W.inverse_mass.push_back(0);
  }
}

/// Position of j among the bodies of the problem.
inline std::int32_t second_body(const StepInput& step, const Candidate& pair) {
  if (pair.j >= 0) return pair.j;
  return static_cast<std::int32_t>(step.bodies.count()) + 1 + driven_wall_of(step.walls, pair);
}

/// Writes contact a of the problem.
template <class Problem>
void assemble_contact(const StepInput& step, const Candidate& pair, int a, Problem& problem) {
  constexpr int dim = Problem::dim;
  const StepLaws& laws = step.laws;
  const Bodies& bodies = step.bodies;
  const auto of_driven = [&step](std::int32_t k) { return step.free.driven[k]; };
  const Point wall = wall_velocity(step, pair, of_driven);
  const Point u = relative_velocity(pair, step.free, wall);
  problem.q[dim * a] = normal_part(pair, u) + pair.gap / step.time_step;  // it may act before it touches
  const std::int32_t second = second_body(step, pair);
  if (problem.W.cell) {
    // As they are now: the normal is that of the position where they meet.
    const Point arm = laws.period.nearest(position(bodies, pair.i) - position(bodies, pair.j));
    problem.W.arm_x[a] = arm.x, problem.W.arm_z[a] = arm.z;
  }
  if constexpr (dim == 3) {
    each_law(laws, [&](const auto& law) {
      if constexpr (requires { law.radius_ratio(pair, bodies); }) {
        const double radius_ratio = law.radius_ratio(pair, bodies);
        problem.W.set(a, pair.i, second, pair.n_x, pair.n_z, radius_ratio);
        problem.q[dim * a + 2] = law.couple_velocity(pair, bodies, step.walls, radius_ratio, step.time_step);
      }
    });
  } else {
    problem.W.set(a, pair.i, second, pair.n_x, pair.n_z);
  }
  if constexpr (dim >= 2) {
    const auto sliding = [&](const Point& velocity) {
      const double u_t = tangential_part(pair, velocity);
      return Problem::Delassus::spin ? surface_sliding(u_t, pair, bodies) : u_t;
    };
    problem.q[dim * a + 1] = sliding(u);
    double* const mu = &problem.mu[Problem::Law::coefficients * a];
    mu[0] = step.friction(pair, [&] { return sliding(relative_velocity(pair, bodies, wall)); });
    if constexpr (Problem::Law::coefficients == 2)
      each_law(laws, [&](const auto& law) {
        if constexpr (requires { law.coefficient(pair, step.materials()); })
          mu[1] = law.coefficient(pair, step.materials());
      });
  }
}

/// Of the velocities in q: those that rounding of positions and velocities leaves there stay below a
/// ten-thousandth of it.
inline double rounding_of(const StepInput& step, const ParallelLoops& loops) {
  struct Largest {
    double place = 0, speed = 0;
    void add(const Largest& more) {
      place = std::max(place, more.place), speed = std::max(speed, more.speed);
    }
  };
  const auto all = loops.combined<Largest>(step.bodies.count(), [&](std::size_t begin, std::size_t end) {
    Largest some;
    for (std::size_t b = begin; b < end; ++b)
      some.add({std::max(std::abs(step.bodies.x[b]), std::abs(step.bodies.z[b])),
                std::max(std::abs(step.free.x[b]), std::abs(step.free.z[b]))});
    return some;
  });
  return 1e4 * std::numeric_limits<double>::epsilon() * (all.place / step.time_step + all.speed);
}

/// Writes the problem in the order of the contacts.
template <class Problem>
void assemble(const StepInput& step, const StepContacts& contacts, const ParallelLoops& loops,
              Problem& problem) {
  constexpr int dim = Problem::dim;
  const std::size_t count = contacts.pairs.size();
  assemble_bodies(step, problem);
  problem.W.resize_uninitialized(count);
  resize_closely(problem.q, dim * count);
  resize_closely(problem.mu, Problem::Law::coefficients * count);
  problem.time_step = step.time_step, problem.rounding = rounding_of(step, loops);
  loops.each(count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t a = begin; a < end; ++a)
      assemble_contact(step, contacts.pairs[a], static_cast<int>(a), problem);
  });
}

}  // namespace drumlin::particles
