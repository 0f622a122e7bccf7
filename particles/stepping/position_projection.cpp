#include "particles/stepping/position_projection.hpp"

#include <algorithm>

#include "particles/effects/driven_walls.hpp"
#include "particles/parallel/parallel_loops.hpp"
#include "particles/stepping/cell_step.hpp"

namespace drumlin::particles {
namespace {

/// Adds the walls that a force moves. One that presses and is heavier than the mean grain counts as heavy as
/// that: a few sweeps would not lift it off the grains, its force would push it further in each step, and
/// overlap would grow without end (docs/decisions.md). Inertia is no matter of positions.
/// A wall without force keeps its mass: one of huge mass is a fixed wall.
void add_driven_walls(const Bodies& bodies, const WallStep& walls, FrictionlessProblem::Delassus& W) {
  W.driven.clear();
  if (walls.driven.empty()) return;
  double of_a_grain = 0;
  for (const double w : bodies.inverse_mass) of_a_grain += w;
  of_a_grain /= static_cast<double>(bodies.count());
  for (const Driven& wall : walls.driven) {
    const bool presses = wall.force != 0;
    W.driven.push_back({wall.direction.x, wall.direction.z,
                        presses ? std::max(wall.inverse_mass, of_a_grain) : wall.inverse_mass});
  }
  W.inverse_mass.resize(W.inverse_mass.size() + walls.driven.size(), 0.0);
}

/// Adds a cell under pressure, with its inertia: it takes up what all contacts ask for together.
void add_cell(const MovingCell* cell, FrictionlessProblem::Delassus& W) {
  W.cell.reset();
  if (cell == nullptr) return;
  W.cell = CellBody{cell->response.inverse_inertia_x, cell->response.inverse_inertia_z};
  W.inverse_mass.push_back(0);
}

}  // namespace

void PositionProjection::apply(const Movable& movable, const ClosePairs& pairs, const SweepPlan& plan,
                               const ProjectionRule& projection) {
  auto& [bodies, walls, driven, cell] = movable;
  if (!pairs.overlap) return;
  const ParallelLoops loops(work_.pool);
  auto& W = problem_.W;
  W.inverse_mass.assign(bodies.inverse_mass.begin(), bodies.inverse_mass.end());
  W.inverse_mass.push_back(0);
  const auto fixed = static_cast<std::int32_t>(bodies.count());
  add_driven_walls(bodies, walls, W);
  const bool gives_way = movable.cell != nullptr && movable.cell->response.pressed();
  add_cell(gives_way ? movable.cell : nullptr, W);
  W.resize_uninitialized(pairs.count());
  resize_closely(problem_.q, pairs.count());
  // Named anew: clang 14 captures no structured binding.
  loops.each_of(pairs.pieces(), [&, &walls = walls](int p) {
    std::int32_t a = pairs.earlier[p];
    for (const ClosePair& pair : pairs.of(p)) {
      std::int32_t second = pair.j < 0 ? fixed : pair.j;
      if (pair.j < 0 && !walls.driven_of_shape.empty()) second += 1 + walls.driven_of_shape[-1 - pair.j];
      if (gives_way) {
        const Point arm = arm_of(movable.bodies, pair.i, pair.j, pair.gap, {pair.n_x, pair.n_z});
        W.arm_x[a] = arm.x, W.arm_z[a] = arm.z;
      }
      W.set(a, pair.i, second, pair.n_x, pair.n_z);
      problem_.q[a++] = projection.wanted_gap(pair.gap);
    }
  });
  W.plan = plan;
  solution_.impulses.clear();
  resize_closely(solution_.impulses, pairs.count());
  StoppingRule rule;
  rule.tolerance = projection_tolerance;
  rule.max_sweeps = projection.sweeps;
  // What is left is seen, and reported, as the overlap of the next step.
  (void)solve_accelerated(problem_, rule, work_, solution_);
  const auto& moved = solution_.velocities.bodies;
  loops.each(bodies.count(), [&, &bodies = bodies](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      bodies.x[b] += moved[b].x;
      bodies.z[b] += moved[b].z;
    }
  });
  for (std::size_t k = 0; k < walls.driven.size(); ++k) {
    const auto& wall = moved[fixed + 1 + k];
    shift_driven_wall(k, wall.x * W.driven[k].e_x + wall.z * W.driven[k].e_z, walls, driven[k]);
  }
  if (gives_way) stretch_cell(cell_answer(problem_, moved), cell->state, bodies);
}

}  // namespace drumlin::particles
