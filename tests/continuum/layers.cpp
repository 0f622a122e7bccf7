// The finite elements against flows that can be written down, and against what they must refuse.
#include "boxes.hpp"
#include "continuum/reference/closed_forms.hpp"
#include "coupling/common/errors.hpp"

namespace drumlin {
using namespace continuum;
namespace {

using namespace testing_boxes;

const LogLaw paper{0.35, 0.013};
constexpr double nu = 0.82;

FlowProblem incline(double theta_deg) {
  FlowProblem problem = strip(20, 10, paper, constant_traction(0, 0));
  problem.density = nu;
  problem.slope = FixedSlope{theta_deg * degree};
  // p_min acts where p is below it, in the uppermost hundredth of a grain; eps far below the slowest shear,
  // 0.1 at the top.
  problem.regularisation = {.shear_rate = 1e-5, .pressure = 1e-2};
  return problem;
}

TEST(Incline, CarriesBagnoldsFlow) {
  FlowSolverOptions options;
  options.levels = 2;  // 20 cells over the height
  for (const double theta_deg : {18.0, 18.5, 19.0}) {
    const FlowField field = converged(incline(theta_deg), options);
    const double exact = bagnold_speed(paper, nu, theta_deg * degree, 20, 20);
    // The singular top of H^1.5 and the log law (1e-3 of mu is 3 % of I) leave a few parts in a thousand on
    // this mesh.
    EXPECT_NEAR(state_at(field, {0, -1e-9}).velocity.x, exact, 5e-3 * exact) << theta_deg;
    const PointState middle = state_at(field, {0, -10});
    EXPECT_NEAR(middle.sigma_xz / middle.sigma_zz, std::tan(theta_deg * degree), 1e-3);
    EXPECT_NEAR(middle.sigma_xx / middle.sigma_zz, 1, 1e-6);
  }
}

TEST(Incline, RefusesASlopeWithoutSteadyFlow) {
  try {
    (void)solve_flow(incline(23));
    FAIL() << "solved";
  } catch (const NotConvergedError& error) {
    EXPECT_NE(std::string(error.what()).find("no local steady state"), std::string::npos);
  }
}

TEST(Incline, SaysWhereItStoppedWhenItDidNotConverge) {
  FlowSolverOptions options;
  options.levels = 1;
  options.max_iterations = 2;
  options.tolerance = 1e-30;  // below rounding: never met
  const FlowSolution solution = solve_flow(incline(18), options);
  EXPECT_FALSE(solution.report.converged);
  EXPECT_NE(solution.report.failure.find("phase"), std::string::npos) << solution.report.failure;
  EXPECT_NE(solution.report.failure.find("residual"), std::string::npos);
}

TEST(PlaneShear, RunsAtTheRateThatBelongsToItsStress) {
  const double P = 4, mu = 0.2901;  // mu(0.01) of the paper's law
  FlowProblem problem = strip(10, 4, paper, constant_traction(mu * P, -P));
  problem.regularisation = {.shear_rate = 1e-7, .pressure = 1e-4};
  FlowSolverOptions options;
  options.levels = 1;
  options.tolerance = 1e-11;
  const FlowField field = converged(problem, options);
  const double rate = plane_shear_rate(paper, P, mu * P);
  EXPECT_NEAR(rate, 0.02, 1e-4);
  for (const double z : {-9.0, -5.0, -0.5}) {
    const PointState s = state_at(field, {0.1, z});
    // Uniform shear lies in the discrete space. The floor of mu (3e-6) moves the rate by 3e-6/b = 3e-4 of
    // itself.
    EXPECT_NEAR(s.dvx_dz, rate, 5e-4 * rate);
    EXPECT_NEAR(s.velocity.x, rate * (10 + z), 5e-4 * rate * 10);
    EXPECT_NEAR(s.sigma_zz, P, 1e-8);
    EXPECT_NEAR(s.sigma_xx, P, 1e-8);  // k = 1 exactly
    EXPECT_NEAR(s.sigma_xz, mu * P, 1e-8);
  }
}

TEST(VerticalChute, HasThePlugAndTheShearLayerOfItsClosedForm) {
  // Half of the chute: wall below, middle above, where nothing shears. The weight lies along it.
  const double P = 5, W = 2.2;
  FlowProblem problem = strip(W, 20, paper, constant_traction(0, -P));
  problem.extra_force = [](Vec2) { return Vec2{nu, 0}; };
  problem.regularisation = {.shear_rate = 1e-5, .pressure = 1e-4};
  FlowSolverOptions options;
  options.levels = 2;
  const FlowField field = converged(problem, options);
  const double plug = vertical_chute_speed(paper, nu, P, W, 0);
  // The shear layer is b P/nu = 0.08 d thick, a cell and a half: 1 % on this mesh.
  EXPECT_NEAR(state_at(field, {0, -1e-9}).velocity.x, plug, 0.01 * plug);
  EXPECT_NEAR(state_at(field, {0, -W / 2}).velocity.x, plug, 0.01 * plug);
  const double here = vertical_chute_speed(paper, nu, P, W, W - 0.1);
  EXPECT_NEAR(state_at(field, {0, 0.1 - W}).velocity.x, here, 0.01 * plug);
}

TEST(Box, RigidRotationOnTopOfAFlowChangesNoStress) {
  FlowProblem problem;
  problem.domain = BoxDomain{.width = 2, .height = 1, .cells_x = 6, .cells_z = 3};
  problem.law = paper;
  problem.slope = FixedSlope{0};
  problem.regularisation = {.shear_rate = 1e-2, .pressure = 0.1};
  problem.boundary[Side::top] = constant_traction(0.5, -3);
  FlowSolverOptions options;
  options.levels = 1;
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
