// Finite elements across a gap against the solution by quadrature: order, balances, frames.
#include "boxes.hpp"
#include "continuum/postprocessing/gap_profiles.hpp"
#include "gap_flows.hpp"

namespace drumlin::gaps_test {
using namespace continuum;
namespace {

using namespace testing_boxes;
using namespace testing_gaps;

struct Solved {
  std::vector<double> mesh_errors;  ///< on each mesh
  FlowField field;
  GapComparison comparison;
};

Solved solved(const GapFlow& flow) {
  const auto& [gap, cell, regularisation] = flow;
  const FlowMesh mesh{.surface_cell = cell, .surface_zone = 100, .levels = 3};
  const FlowProblem problem = gap_problem(gap, steep, mesh, regularisation);
  FlowSolverOptions options;
  options.levels = mesh.levels;
  options.coarse_tolerance = options.tolerance;  // the errors of all meshes are compared
  std::vector<double> errors;
  FlowObserver observer;
  observer.level_finished = [&](int, const FlowField& field) {
    errors.push_back(gap_comparison(field, gap, steep, problem.regularisation).mesh_error);
  };
  const FlowField field = converged(problem, options, observer);
  return {errors, field, gap_comparison(field, gap, steep, problem.regularisation)};
}

void expect_order(const Solved& flow) {
  ASSERT_EQ(flow.mesh_errors.size(), 3u);
  for (int level = 1; level < 3; ++level)
    EXPECT_GT(std::log2(flow.mesh_errors[level - 1] / flow.mesh_errors[level]), 2.5)
        << "errors " << flow.mesh_errors[level - 1] << ", " << flow.mesh_errors[level];
}

void expect_balances(const FlowField& field, const Gap& gap, const char* of_walls) {
  const ScalarSet checks = gap_checks(field, gap);
  // The discrete equations hold them to the tolerance of the solver, 1e-8 of the weight.
  EXPECT_NEAR(checks.value("power_relative_error"), 0, 1e-6);
  EXPECT_NEAR(checks.value(of_walls), 0, 1e-6);
}

TEST(InclineFlow, ConvergesToItsSolutionWithTheOrderOfQ2) {
  const Gap gap = incline_flow().gap;
  const Solved flow = solved(incline_flow());
  expect_order(flow);
  expect_balances(flow.field, gap, "force_relative_error");
  EXPECT_NEAR(gap_scalars(flow.field, gap).value("mu_wall"), std::tan(18 * degree), 1e-6);
}

// The kink between plug and shear layer lies within a cell.
TEST(InclineFlow, OfGrainsThatHoldTogetherHasAPlug) {
  const Gap gap = incline_flow(25).gap;
  const CohesiveLaw law{0.3, 0.3, 1.1};  // a plug of 2.4 d
  const FlowProblem problem = gap_problem(gap, law, {.surface_cell = 0.25, .surface_zone = 100, .levels = 3},
                                          {.shear_rate = 1e-5, .pressure = 1e-3});
  FlowSolverOptions options;
  options.levels = 3;
  const FlowField field = converged(problem, options);
  EXPECT_LT(gap_comparison(field, gap, law, problem.regularisation).mesh_error_max, 1e-3);
  expect_balances(field, gap, "force_relative_error");
  const double surface = state_at(field, {0, -0.01}).velocity.x;
  EXPECT_NEAR(state_at(field, {0, -2}).velocity.x, surface, 1e-3 * surface);
  EXPECT_LT(state_at(field, {0, -4}).velocity.x, 0.95 * surface);
}

TEST(ChuteFlow, ConvergesToItsSolutionWithTheOrderOfQ2) {
  const Gap gap = chute_flow().gap;
  const Solved flow = solved(chute_flow());
  expect_order(flow);
  expect_balances(flow.field, gap, "force_relative_error");
  EXPECT_NEAR(gap_scalars(flow.field, gap).value("mu_wall"), nu * 4 / 11, 1e-6);
}

TEST(PlaneShearFlow, IsExactUnderAPressedWall) {
  const Gap gap{.depth = 10, .nu = nu, .pressure = 4, .speed = 0.4, .scalars = {"mu_wall", "I"}};
  const FlowProblem problem = gap_problem(gap, steep, {.surface_cell = 2.5, .surface_zone = 100, .levels = 1},
                                          {.shear_rate = 1e-7, .pressure = 1e-6});
  FlowSolverOptions options;
  options.levels = 1;
  options.tolerance = 1e-11;
  const FlowField field = converged(problem, options);
  // Uniform shear lies in the discrete space: I = 0.4/10/2.
  const ScalarSet scalars = gap_scalars(field, gap);
  EXPECT_NEAR(scalars.value("I"), 0.02, 1e-9);
  EXPECT_NEAR(scalars.value("mu_wall"), steep.friction(0.02).mu, 1e-9);
  EXPECT_LT(gap_comparison(field, gap, steep, problem.regularisation).mesh_error_max, 1e-9);
  const ProfileSet profiles = gap_profiles(field, gap, 1);
  EXPECT_EQ(profiles.z.size(), 10u);
  for (const double p : profiles.column("sigma_zz").value) EXPECT_NEAR(p, 4, 1e-8);
}

TEST(AnnulusFlow, ConvergesToItsSolutionWithTheOrderOfQ2) {
  const Gap gap = annulus_flow().gap;
  const Solved flow = solved(annulus_flow());
  expect_order(flow);
  expect_balances(flow.field, gap, "torque_relative_error");
  EXPECT_NEAR(gap_checks(flow.field, gap).value("Q_relative_error"), 0, 1e-6);
  EXPECT_NEAR(gap_scalars(flow.field, gap).value("mu_wall"), flow.comparison.closed_form.value("mu_wall"),
              1e-3);
  // In axes that turn with the place: the pressure of the outer wall everywhere, v_x > 0, nothing across.
  const ProfileSet profiles = gap_profiles(flow.field, gap, 1);
  for (std::size_t row = 0; row < profiles.z.size(); ++row) {
    EXPECT_NEAR(profiles.column("sigma_zz").value[row], 4, 0.01);
    EXPECT_NEAR(profiles.column("v_z").value[row], 0, 1e-4);
    EXPECT_GT(profiles.column("v_x").value[row], 0);
    EXPECT_GT(profiles.column("sigma_xz").value[row], 0);
  }
}

}  // namespace
}  // namespace drumlin::gaps_test
