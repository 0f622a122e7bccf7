// The assembled tangent against differences of the assembled residual.
#include "boxes.hpp"
#include "continuum/fem/detail/assembly.hpp"

namespace drumlin {
namespace {

using namespace testing_boxes;

TEST(AssembledTangent, IsTheDerivativeOfTheResidual) {
  FlowProblem problem;
  problem.domain = ChordDomain{
      .radius = 6, .axis_offset = 0.5, .surface_cell = 3, .surface_zone = 2};  // hanging nodes too
  problem.law = LogLaw{0.35, 0.013};
  problem.density = 0.8;
  problem.slope = FixedSlope{0.3};
  problem.boundary[Side::top] = NormalSpring{100};
  problem.boundary[Side::bottom] = at_rest();
  const fem::Discretisation d(problem);
  const fem::Setting setting{
      problem.law, {.shear_rate = 0.2, .pressure = 0.3}, {.share = 0.6, .surface = 0.5, .gradient = 0.7}};

  fem::State state;
  state.theta = 0.3;
  state.solution.reinit(d.unknowns.n_dofs());
  dealii::Vector<double> direction(d.unknowns.n_dofs());
  for (unsigned int i = 0; i < state.solution.size(); ++i) {
    state.solution[i] = std::sin(1.7 * i) + (d.is_velocity[i] ? 0 : 1);
    direction[i] = std::cos(2.3 * i);
  }
  d.homogeneous.distribute(state.solution);
  d.homogeneous.distribute(direction);
  state.dual = fem::dual_of(d, setting.regularisation, state.solution);

  fem::System system;
  system.matrix.reinit(d.pattern);
  fem::assemble_tangent(problem, d, setting, state, system);
  dealii::Vector<double> by_tangent(direction.size());
  system.matrix.vmult(by_tangent, direction);

  const double h = 1e-6;
  const auto residual_at = [&](double step) {
    fem::State moved = state;
    moved.solution.add(step, direction);
    fem::System other;
    fem::assemble_residual(problem, d, setting, moved, other);
    return other.residual;
  };
  dealii::Vector<double> by_difference = residual_at(h);
  by_difference -= residual_at(-h);
  by_difference *= 1 / (2 * h);
  for (unsigned int i = 0; i < by_tangent.size(); ++i)
    if (d.homogeneous.is_constrained(i)) by_tangent[i] = 0;  // the matrix holds a diagonal of its own there
  const double size = by_difference.l2_norm();
  by_difference -= by_tangent;
  EXPECT_LT(by_difference.l2_norm(), 1e-7 * size);
}

}  // namespace
}  // namespace drumlin
