#pragma once
// The assembled tangent against differences of the assembled residual.
#include <cmath>

#include "continuum/fem/detail/assembly.hpp"
#include "continuum/fem/detail/direct_solver.hpp"
#include "continuum/fem/detail/turning.hpp"

namespace drumlin::testing_tangent {

inline continuum::FlowProblem small_segment() {
  continuum::FlowProblem problem;
  problem.domain = continuum::ChordDomain{
      .radius = 6, .axis_offset = 0.5, .surface_cell = 3, .surface_zone = 2};  // hanging nodes too
  problem.law = LogLaw{0.35, 0.013};
  problem.density = 0.8;
  problem.slope = continuum::FixedSlope{0.3};
  problem.boundary[continuum::Side::top] = continuum::NormalSpring{100};
  problem.boundary[continuum::Side::bottom] =
      continuum::PrescribedVelocity{[](continuum::Vec2) { return continuum::Vec2{}; }};
  return problem;
}

/// Norm of the difference between the two along one direction over the norm of the derivative; central
/// differences of half width h.
inline double tangent_error(const continuum::FlowProblem& problem, bool inertia, double h) {
  const continuum::fem::Discretisation d(problem);
  const auto before = std::make_shared<const continuum::fem::FieldVector>(d.field());
  continuum::fem::Setting setting{problem.law, {.shear_rate = 0.2, .pressure = 0.3}, std::nullopt};
  if (inertia)
    setting.inertia = continuum::fem::InertiaSetting{.share = 0.7, .time_step = 2, .before = before};

  continuum::fem::State state;
  state.theta = 0.3;
  state.solution = d.field();
  continuum::fem::FieldVector direction = d.field();
  for (std::size_t k = 0; k < d.is_velocity.size(); ++k) {
    const auto i = static_cast<double>(d.owned.nth_index_in_set(k));
    state.solution.local_element(k) = std::sin(1.7 * i) + (d.is_velocity[k] ? 0 : 1);
    direction.local_element(k) = std::cos(2.3 * i);
  }
  d.homogeneous.distribute(state.solution);
  d.homogeneous.distribute(direction);
  state.solution.update_ghost_values();
  direction.update_ghost_values();
  state.dual = continuum::fem::dual_of(d, setting.regularisation, state.solution);
  if (continuum::fem::holds_fields(problem)) state.held = continuum::fem::held_from(problem, d, state);

  continuum::fem::System system(d);
  continuum::fem::assemble_tangent(problem, d, setting, state, system);
  continuum::fem::FieldVector by_tangent = d.field();
  continuum::fem::multiply(system.matrix, direction, by_tangent);

  const auto residual_at = [&](double step) {
    continuum::fem::State moved = state;
    moved.solution.add(step, direction);
    moved.solution.update_ghost_values();
    continuum::fem::System other(d);
    continuum::fem::assemble_residual(problem, d, setting, moved, other);
    return other.residual;
  };
  continuum::fem::FieldVector by_difference = residual_at(h);
  by_difference -= residual_at(-h);
  by_difference *= 1 / (2 * h);
  for (const auto i : d.owned)
    if (d.homogeneous.is_constrained(i)) by_tangent[i] = 0;  // the matrix holds a diagonal of its own there
  const double size = by_difference.l2_norm();
  by_difference -= by_tangent;
  return by_difference.l2_norm() / size;
}

}  // namespace drumlin::testing_tangent
