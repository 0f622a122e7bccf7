// The law with k in the finite elements: layers that can be written down.
#include "boxes.hpp"
#include "continuum/reference/closed_forms.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"

namespace drumlin::with_k {
using namespace continuum;
namespace {

using namespace testing_boxes;

const LogLaw paper{0.35, 0.013};

TurnedStress some_k() { return {.k = StressRatioLaw({1e-3, 1e-1}, {0.93, 1.07})}; }

TEST(PlaneShearWithK, CarriesExactlyKAndTheSameRate) {
  const double P = 4, mu = 0.2901;
  FlowProblem problem = strip(10, 4, paper, constant_traction(mu * P, -P));
  problem.turned = some_k();
  problem.regularisation = {.shear_rate = 1e-7, .pressure = 1e-4};
  FlowSolverOptions options = one_mesh();
  options.tolerance = 1e-11;
  const FlowField field = converged(problem, options);
  const double rate = plane_shear_rate(StressLaw(paper), P, mu * P);
  for (const double z : {-9.0, -5.0, -0.5}) {
    const PointState s = state_at(field, {0.1, z});
    // Uniform, hence exact on any mesh; p_min^2/p^2 = 1e-9 moves mu, that over b = 1e-7 the rate.
    EXPECT_NEAR(s.dvx_dz / rate, 1, 1e-6);
    EXPECT_NEAR(s.sigma_zz, P, 1e-8);
    EXPECT_NEAR(s.sigma_xz, mu * P, 1e-8);
    const double k = some_k().k.at_ln(std::log(s.dvx_dz / std::sqrt(P))).value;
    EXPECT_NEAR(s.sigma_xx / s.sigma_zz, k, 1e-7);
    EXPECT_NEAR(s.k, k, 1e-7);
    EXPECT_NEAR(std::tan(2 * s.axis_angle), (k - 1) / (2 * mu), 1e-6);
  }
}

const DrumGeometry drum = small_drum();

FlowProblem small_drum_with_k() {
  FlowProblem problem = small_drum_problem();
  problem.turned = TurnedStress{.k = StressRatioLaw({1e-4, 1e-2, 1e-1}, {0.96, 1.03, 1.0})};
  return problem;
}

TEST(SmallDrumWithK, BalancesMassTorqueAndPower) {
  FlowSolverOptions options = one_mesh();
  int seen = 0;
  double theta_without = 0;
  FlowObserver observer;
  observer.solved_plain = [&](const FlowField& field) {
    ++seen;
    theta_without = field.theta();
  };
  const FlowSolution solution = ended(solve_flow(small_drum_with_k(), options, observer));
  EXPECT_EQ(seen, 1);
  EXPECT_LT(solution.report.picard_change, options.picard_tolerance);
  EXPECT_GT(solution.report.picard_updates, 1);
  const FlowIntegrals sums = solution.field.integrals({0, drum.axis_offset});
  EXPECT_NEAR(discharge(solution.field, drum) / drum.expected_Q(), 1, 1e-3);
  EXPECT_NEAR(sums.given_side_torque / sums.weight_torque, -1, 1e-4);
  EXPECT_NEAR(sums.dissipation / (sums.given_side_power + sums.weight_power), 1, 1e-3);
  EXPECT_EQ(sums.ill_posed_area, 0);
  // k within 4 % of one turns the stress by up to 3 degrees but hardly moves the slope.
  EXPECT_NEAR(solution.field.theta(), theta_without, 0.5 * degree);
}

TEST(SmallDrumWithK, IsTheSameForAnObserverThatTurns) {
  FlowSolverOptions options = one_mesh();
  options.picard_tolerance = 1e-6;
  FlowProblem laboratory = small_drum_with_k();
  FlowProblem turning = laboratory;
  turning.frame = RotatingFrame{drum.rotation, drum.axis_offset};
  const FlowField a = converged(laboratory, options), b = converged(turning, options);
  EXPECT_NEAR(a.theta(), b.theta(), 1e-5);
  for (const Vec2 place : {Vec2{0, -0.5}, {0, -3}, {5, -2}, {2, -9}}) {
    const PointState here = state_at(a, place), there = state_at(b, place);
    EXPECT_NEAR(here.velocity.x, there.velocity.x, 1e-5);
    EXPECT_NEAR(here.sigma_xx, there.sigma_xx, 1e-4);
    EXPECT_NEAR(here.axis_angle, there.axis_angle, 1e-4);
  }
}

}  // namespace
}  // namespace drumlin::with_k
