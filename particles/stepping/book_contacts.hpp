#pragma once
// The work of the contacts of a step, from the contact problem to the energy ledger.
#include <optional>

#include "particles/contact/solution.hpp"
#include "particles/stepping/assembly.hpp"
#include "particles/stepping/energy_ledger.hpp"

namespace drumlin::particles {

/// Mean velocity over the step, impacts aside, of the wall of a pair, once `step.free.driven` holds the
/// velocities that contacts left to driven walls.
template <class Problem>
Point mean_wall_velocity(const StepInput& step, const StepContacts& contacts, const Candidate& pair) {
  const Point prescribed{pair.wall_v_x, pair.wall_v_z};
  if constexpr (drives_walls<Problem>)
    if (const std::int32_t k = driven_wall_of(step.walls, pair); k >= 0) {
      const Driven& wall = step.walls.driven[k];
      const double mean = (step.driven[k].velocity + contacts.wall_jumps[k] + step.free.driven[k]) / 2;
      return along(prescribed, wall, mean - free_velocity(wall, step.driven[k], step.time_step));
    }
  return prescribed;
}

/// What the mean velocity of contact a over the step lacks if the rates of a cell are those without contacts
/// and the grains do not follow their change: the part of the cell.
template <class Problem>
Point image_velocity(const Problem& problem, Point change, const Candidate& pair, std::size_t a) {
  Point image{pair.wall_v_x, pair.wall_v_z};
  if constexpr (drives_walls<Problem>)
    if (problem.W.cell) {
      image.x -= change.x * problem.W.arm_x[a] / 2;
      image.z -= change.z * problem.W.arm_z[a] / 2;
    }
  return image;
}

/// Books the contacts of a step whose bodies have been moved (step.bodies) but not its driven walls,
/// nor its cell.
template <class Problem>
void book_contacts(const StepInput& step, const StepContacts& contacts, const Problem& problem,
                   const Solution<Problem>& solution, const EnergyBooks& books, EnergyLedger& ledger) {
  constexpr int dim = Problem::dim;
  const StepLaws& laws = step.laws;
  const auto& impulses = solution.impulses;
  Point change;
  if constexpr (drives_walls<Problem>) change = cell_answer(problem, solution.velocities.bodies);
  if (dim == 3 && !ledger.rolling) ledger.rolling = 0;
  if (laws.cohesion && !ledger.cohesion) ledger.cohesion = 0;
  for (std::size_t a = 0; a < contacts.pairs.size(); ++a) {
    const Candidate& pair = contacts.pairs[a];
    WorkingContact contact;
    contact.i = pair.i, contact.j = pair.j, contact.n_x = pair.n_x, contact.n_z = pair.n_z;
    contact.normal = impulses[dim * a];
    if constexpr (dim >= 2) contact.tangential = impulses[dim * a + 1];
    if constexpr (dim == 3) {
      contact.rolling = impulses[dim * a + 2];
      contact.lever = problem.W.lever[a];
      if (pair.j < 0) contact.wall_spin = wall_spin(pair, step.walls, step.time_step);
    }
    if (laws.cohesion) contact.attraction = contacts.attraction[a];
    contact.wall_velocity = pair.j < 0 ? mean_wall_velocity<Problem>(step, contacts, pair)
                                       : image_velocity(problem, change, pair, a);
    books.add(contact, step.bodies, ledger);
  }
}

}  // namespace drumlin::particles
