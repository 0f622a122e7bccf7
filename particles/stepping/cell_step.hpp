#pragma once
// What the contacts of a step do to a cell under pressure.
#include <span>

#include "particles/contact/problems.hpp"
#include "particles/effects/moving_cell.hpp"
#include "particles/stepping/step_contacts.hpp"

namespace drumlin::particles {

/// Branch of a pair in a cell, from the centre of j, or of its image, to that of i.
inline Point arm_of(const Bodies& bodies, std::int32_t i, std::int32_t j, double gap, Point normal) {
  const double length = bodies.radius[i] + bodies.radius[j] + gap;
  return length * normal;
}

/// Change of the rates of the cell that the impulses of a solved problem make.
template <class Problem, class Velocities>
Point cell_answer(const Problem& problem, const Velocities& bodies) {
  if (!problem.W.cell || problem.contacts() == 0) return {};
  const auto& rates = bodies[problem.W.cell_body()];
  return {rates.x, rates.z};
}

/// Keeps what the impacts of a step push the cell with; it answers in the next step.
inline void keep_impacts_of_cell(std::span<const ImpactImpulse> impacts, const Bodies& bodies,
                                 CellState& cell) {
  cell.struck_x = cell.struck_z = 0;
  for (const ImpactImpulse& s : impacts) {
    const Point arm = arm_of(bodies, s.i, s.j, 0, {s.n_x, s.n_z});
    const Point impulse = with_parts({s.n_x, s.n_z}, s.normal, s.tangential);
    cell.struck_x += arm.x * impulse.x, cell.struck_z += arm.z * impulse.z;
  }
}

}  // namespace drumlin::particles
