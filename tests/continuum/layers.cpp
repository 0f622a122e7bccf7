// What every flow must hold.
#include "boxes.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
using namespace continuum;
namespace {

using namespace testing_boxes;

const LogLaw paper{0.35, 0.013};

TEST(FlowReport, SaysWhereItStoppedWhenItDidNotConverge) {
  FlowSolverOptions options = one_mesh();
  options.max_iterations = 2;
  options.tolerance = 1e-30;  // below rounding: never met
  const FlowSolution solution = solve_flow(small_drum_problem(), options);
  EXPECT_FALSE(solution.report.converged);
  expect_has(solution.report.failure, "phase");
  expect_has(solution.report.failure, "residual");
}

TEST(Box, RigidRotationOnTopOfAFlowChangesNoStress) {
  FlowProblem problem;
  problem.domain = BoxDomain{.width = 2, .height = 1, .cells_x = 6, .cells_z = 3};
  problem.law = paper;
  problem.slope = FixedSlope{0};
  problem.regularisation = {.shear_rate = 1e-2, .pressure = 0.1};
  problem.boundary[Side::top] = constant_traction(0.5, -3);
  FlowSolverOptions options = one_mesh();
  options.tolerance = 1e-12;
  const auto with_rotation = [&](double rotation) {
    const PrescribedVelocity sides{[rotation](Vec2 p) { return rigid_rotation(rotation, 0.3, p); }};
    for (const Side side : {Side::bottom, Side::left, Side::right}) problem.boundary[side] = sides;
    return converged(problem, options);
  };
  const FlowField still = with_rotation(0), turning = with_rotation(0.7);
  for (const Vec2 p : {Vec2{0.3, -0.2}, Vec2{-0.8, -0.1}, Vec2{0.05, -0.7}}) {
    const PointState a = state_at(still, p), b = state_at(turning, p);
    const Vec2 rigid = rigid_rotation(0.7, 0.3, p);
    EXPECT_NEAR(b.velocity.x - rigid.x, a.velocity.x, 1e-8);
    EXPECT_NEAR(b.velocity.z - rigid.z, a.velocity.z, 1e-8);
    EXPECT_NEAR(b.sigma_xx, a.sigma_xx, 1e-8);
    EXPECT_NEAR(b.sigma_zz, a.sigma_zz, 1e-8);
    EXPECT_NEAR(b.sigma_xz, a.sigma_xz, 1e-8);
  }
}

}  // namespace
}  // namespace drumlin
