#pragma once
// The work of the contacts of a step, from the contact problem to the energy ledger.
#include <optional>

#include "particles/contact/solution.hpp"
#include "particles/stepping/assembly.hpp"
#include "particles/stepping/energy_ledger.hpp"

namespace drumlin::particles {

/// What the mean velocity of contact a over the step lacks if the rates of a cell are those without contacts
/// and the grains do not follow their change: the part of the cell.
template <class Problem>
Point image_velocity(const Problem& problem, Point change, const Candidate& pair, std::size_t a) {
  Point image = wall_velocity(pair);
  if (problem.W.cell) {
    image.x -= change.x * problem.W.arm_x[a] / 2;
    image.z -= change.z * problem.W.arm_z[a] / 2;
  }
  return image;
}

/// The grains with the mean of their velocities before and after a step.
inline Bodies mean_motion(const Bodies& before, const Bodies& now) {
  Bodies mean = before;
  const auto half_way = [](const std::vector<double>& from, const std::vector<double>& to,
                           std::vector<double>& at) {
    for (std::size_t b = 0; b < at.size(); ++b) at[b] = (from[b] + to[b]) / 2;
  };
  half_way(before.v_x, now.v_x, mean.v_x), half_way(before.v_z, now.v_z, mean.v_z);
  half_way(before.spin, now.spin, mean.spin);
  return mean;
}

/// Opens the accounts of the effects of the scene, and adds what the law of each knows of its work.
inline void add_effect_work(const StepInput& step, const Bodies& before, EnergyLedger& ledger) {
  each_effect(
      [&]<class E>(const auto& law, std::optional<double>& work, const std::optional<E>&) {
        if constexpr (requires { E::account; })
          if (law && !work) work = 0;
        if constexpr (requires { law->work(before, step.bodies, step.time_step); })
          if (law) add_work(law->work(before, step.bodies, step.time_step), *work, ledger);
      },
      step.laws, ledger.effects, Effects{});
}

/// Adds the work of the contacts of a step whose bodies have been moved (step.bodies) but not its driven
/// walls, nor its cell.
template <class Problem>
void add_contact_work(const StepInput& step, const StepContacts& contacts, const Problem& problem,
                      const Solution<Problem>& solution, const StepEnergy& step_energy,
                      EnergyLedger& ledger) {
  constexpr int dim = Problem::dim;
  const Bodies mean = mean_motion(step_energy.before(), step.bodies);
  const Point change = cell_answer(problem, solution.velocities.bodies);
  // Mean velocity over the step, impacts aside; step.free.driven holds what contacts left to driven walls.
  const auto of_driven = [&](std::int32_t k) {
    return (step.driven[k].velocity + contacts.wall_jumps[k] + step.free.driven[k]) / 2;
  };
  add_effect_work(step, step_energy.before(), ledger);
  for (std::size_t a = 0; a < contacts.pairs.size(); ++a) {
    Candidate pair = contacts.pairs[a];
    const Point of_j = pair.j < 0 ? wall_velocity(step, pair, of_driven)
                                  : image_velocity(problem, change, pair, a);  // beyond that of j itself
    set_wall_velocity(pair, of_j);
    const Point u = relative_velocity(pair, mean, of_j);
    const double u_n = normal_part(pair, u);
    const auto [r_n, r_t, r_c] = parts_of<Problem>(solution.impulses, a);
    add_work(r_n * u_n, ledger.impacts, ledger);
    if constexpr (dim >= 2) {
      const double u_t = tangential_part(pair, u);
      add_work(r_t * (mean.spin.empty() ? u_t : surface_sliding(u_t, pair, mean)), ledger.friction, ledger);
    }
    const auto add_law_work = [&, r_c = r_c](const auto& law, std::optional<double>& work) {
      if constexpr (requires { law->attraction(pair, step.materials()); })
        if (law) add_work(-step.time_step * law->attraction(pair, step.materials()) * u_n, *work, ledger);
      if constexpr (dim == 3 && requires { law->radius_ratio(pair, mean); }) {
        const double radius_ratio = law->radius_ratio(pair, mean);
        add_work(r_c * law->couple_velocity(pair, mean, step.walls, radius_ratio, step.time_step), *work,
                 ledger);
        add_work(r_c * law->wall_part(pair, mean, step.walls, step.time_step), ledger.walls, ledger);
      }
    };
    each_effect(add_law_work, step.laws, ledger.effects);
    if (pair.j < 0 || !is_zero(of_j))
      add_work(dot(with_parts(normal(pair), r_n - contacts.attraction_of(a), r_t), of_j), mover(ledger),
               ledger);
  }
}

}  // namespace drumlin::particles
