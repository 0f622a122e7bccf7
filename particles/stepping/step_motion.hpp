#pragma once
// The last phases of a step: grains, cells and walls move, and overlap that is left is projected away.
#include <algorithm>
#include <optional>

#include "particles/stepping/cell_step.hpp"
#include "particles/stepping/contact_work.hpp"
#include "particles/stepping/step_state.hpp"

namespace drumlin::particles {

/// New velocities from the solution, then new positions. Of driven walls the velocities alone.
template <class Problem>
void move_grains(const StepInput& step, Bodies& bodies, StepState<Problem>& s) {
  const StepEnd end = s.end_of(step);
  const bool loaded = !end.changes.empty();
  const auto& changes = s.solution.velocities.bodies;
  find_flights(end, s.contacts.pairs, s.pair_bodies(), s.flies);
  s.loops().each(bodies.count(), [&](std::size_t begin, std::size_t stop) {
    for (std::size_t b = begin; b < stop; ++b) {
      const Point shift = end.shift(b), d = end.displacement(b, s.flies[b]), v = end.velocity(b);
      if constexpr (StepState<Problem>::spin)
        if (end.is_pushed(b)) spin_up(bodies, b, changes[b].s);
      bodies.v_x[b] = v.x, bodies.v_z[b] = v.z;
      bodies.x[b] += shift.x + d.x, bodies.z[b] += shift.z + d.z;
    }
  });
  for (const auto& [grain, position] : s.lone) bodies.x[grain] = position.x, bodies.z[grain] = position.z;
  for (std::size_t k = 0; loaded && k < s.free.driven.size(); ++k) {
    const auto& wall = s.problem.W.driven[k];
    const auto& change = changes[s.problem.W.fixed() + 1 + k];
    s.free.driven[k] += change.x * wall.e_x + change.z * wall.e_z;
  }
}

/// Ends the step of a cell: its rates as contacts leave them, which the grains follow, and its new lengths.
template <class Problem>
void deform_cell(const StepInput& step, const MovingState& state, StepState<Problem>& s) {
  CellState& cell = state.cell->state;
  if (step.cell.pressed()) {
    keep_impacts_of_cell(s.contacts.impacts, state.bodies, cell);
    const Point change = cell_answer(s.problem, s.solution.velocities.bodies);
    const double before = s.energy ? kinetic_energy(state.bodies) : 0;
    change_rates_in_step(change, step.time_step, cell, state.bodies);
    if (s.energy) add_cell_work(kinetic_energy(state.bodies) - before, *state.energy);
  }
  move_cell(step.time_step, cell);
  state.laws.period = period_of(cell);
}

template <class Problem>
void move(const StepInput& step, const MovingState& state, WallStep& walls, StepState<Problem>& s) {
  move_grains(step, state.bodies, s);
  if (s.energy) {
    s.energy->move(state.bodies, step.time_step, *state.energy);
    add_contact_work(step, s.contacts, s.problem, s.solution, *s.energy, *state.energy);
  }
  if (state.cell) deform_cell(step, state, s);
  move_driven_walls(s.free, step.time_step, walls, state.driven);
}

/// The overlap that is left, which is then removed on positions alone. No grain ends beyond a segment.
template <class Problem>
Overlap project(const MovingState& state, WallStep& walls, std::optional<LostGrain>& lost,
                StepState<Problem>& s) {
  const WorkMemory::Scope scope(&s.memory);
  const StepLaws& laws = state.laws;
  const MovedContacts contacts{s.contacts.pairs, s.pair_bodies(), s.solution.impulses, Problem::dim,
                               s.problem.W.plan};
  const Crossings moved = s.crossings.undo(walls, laws.period, state.bodies);
  Overlap overlap = s.overlaps.find(contacts, state.bodies, walls, laws.period, laws.detection_margin, lost);
  Crossings pushed;
  if (s.solver.projection.sweeps > 0) {
    s.projection.apply({state.bodies, walls, state.driven, state.cell ? &*state.cell : nullptr},
                       s.overlaps.close(), s.overlaps.plan(), s.solver.projection);
    pushed = s.crossings.undo(walls, laws.period, state.bodies);
  }
  if (const double crossed = std::max(moved.deepest, pushed.deepest); crossed > overlap.max)
    overlap = {overlap.mean, crossed, overlap.loaded};
  if (!lost) lost = moved.lost ? moved.lost : pushed.lost;
  return overlap;
}

}  // namespace drumlin::particles
