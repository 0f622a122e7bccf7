#pragma once
// The assembled tangent against differences of the assembled residual.
#include <cmath>

#include "continuum/fem/detail/assembly.hpp"
#include "continuum/fem/detail/direct_solver.hpp"
#include "continuum/fem/detail/turning.hpp"

namespace drumlin::testing_tangent {
using namespace continuum;

inline FlowProblem small_segment() {
  FlowProblem problem;
  problem.domain = ChordDomain{
      .radius = 6, .axis_offset = 0.5, .surface_cell = 3, .surface_zone = 2};  // hanging nodes too
  problem.law = LogLaw{0.35, 0.013};
  problem.density = 0.8;
  problem.slope = FixedSlope{0.3};
  problem.boundary[Side::top] = NormalSpring{100};
  problem.boundary[Side::bottom] = PrescribedVelocity{[](Vec2) { return Vec2{}; }};
  return problem;
}

/// Norm of the difference between the two along one direction over the norm of the derivative; central
/// differences of half width h.
inline double tangent_error(const FlowProblem& problem, bool inertia, double h) {
  const fem::Discretisation d(problem);
  const auto before = std::make_shared<const fem::FieldVector>(d.field());
  fem::Setting setting{problem.law, {.shear_rate = 0.2, .pressure = 0.3}, std::nullopt};
  if (inertia) setting.inertia = fem::InertiaSetting{.share = 0.7, .time_step = 2, .before = before};

  fem::State state;
  state.theta = 0.3;
  state.solution = d.field();
  fem::FieldVector direction = d.field();
  for (std::size_t k = 0; k < d.is_velocity.size(); ++k) {
    const auto i = static_cast<double>(d.owned.nth_index_in_set(k));
    state.solution.local_element(k) = std::sin(1.7 * i) + (d.is_velocity[k] ? 0 : 1);
    direction.local_element(k) = std::cos(2.3 * i);
  }
  d.homogeneous.distribute(state.solution);
  d.homogeneous.distribute(direction);
  state.solution.update_ghost_values();
  direction.update_ghost_values();
  state.dual = fem::dual_of(d, setting.regularisation, state.solution);
  if (fem::holds_fields(problem)) state.held = fem::held_from(problem, d, state);

  fem::System system(d);
  fem::assemble_tangent(problem, d, setting, state, system);
  fem::FieldVector by_tangent = d.field();
  fem::multiply(system.matrix, direction, by_tangent);

  const auto residual_at = [&](double step) {
    fem::State moved = state;
    moved.solution.add(step, direction);
    moved.solution.update_ghost_values();
    fem::System other(d);
    fem::assemble_residual(problem, d, setting, moved, other);
    return other.residual;
  };
  fem::FieldVector by_difference = residual_at(h);
  by_difference -= residual_at(-h);
  by_difference *= 1 / (2 * h);
  for (const auto i : d.owned)
    if (d.homogeneous.is_constrained(i)) by_tangent[i] = 0;  // the matrix holds a diagonal of its own there
  const double size = by_difference.l2_norm();
  by_difference -= by_tangent;
  return by_difference.l2_norm() / size;
}

}  // namespace drumlin::testing_tangent
