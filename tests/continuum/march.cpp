// Steps in time.
#include "boxes.hpp"
#include "continuum/fem/runtime.hpp"
#include "continuum/postprocessing/drum_profiles.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"

namespace drumlin::march {
using namespace continuum;
namespace {

using namespace testing_boxes;

const DrumGeometry drum = small_drum();

FlowProblem inertial_drum(double rotation = drum.rotation) {
  DrumGeometry geometry = drum;
  geometry.rotation = rotation;
  FlowProblem problem = small_drum_problem(geometry);
  problem.inertia = Inertia{};
  return problem;
}

TEST(March, ReturnsToTheSteadyDrumAfterAPush) {
  const FlowField steady = converged(inertial_drum(), one_mesh());
  const double theta = steady.theta();
  const FlowSolution push =
      ended(march_flow(steady, inertial_drum(1.2 * drum.rotation), {.time_step = 2, .steps = 5}));
  EXPECT_GT(std::abs(push.field.theta() - theta), 1e-4);
  const FlowSolution rest = ended(march_flow(push.field, inertial_drum(), {.time_step = 20, .steps = 40}));
  EXPECT_NEAR(rest.field.theta(), theta, 1e-5);
}

FlowMarch spin_up(int steps, int first = 0) {
  FlowMarch march{.time_step = 5, .steps = steps, .first = first};
  march.boundary = [](double time) {
    return inertial_drum(drum.rotation * std::min(1.0, time / 40)).boundary;
  };
  return march;
}

TEST(March, LeadsFromRestToTheSteadyFlow) {
  const FlowField rest = flow_at_rest(inertial_drum(), one_mesh());
  std::vector<double> Q;
  FlowMarch march = spin_up(80);
  march.stepped = [&](double time, const FlowField& field) {
    DrumGeometry now = drum;
    now.rotation *= std::min(1.0, time / 40);
    Q.push_back(discharge(field, now) / now.expected_Q());
  };
  const FlowSolution end = ended(march_flow(rest, inertial_drum(), march, one_mesh()));
  ASSERT_EQ(Q.size(), 80u);
  for (const double q : Q) EXPECT_NEAR(q, 1, 1e-3);  // mass balance at every time
  // Nodal forces have the acceleration in them: a flow that has come to its steady state balances.
  EXPECT_NEAR(drum_checks(end.field, drum).value("torque_relative_error"), 0, 1e-3);
  EXPECT_NEAR(end.field.theta(), converged(inertial_drum(), one_mesh()).theta(), 1e-4);
}

TEST(March, GoesOnFromAKeptStateToTheLastBit) {
  const auto second_half = [](const FlowField& middle) {
    const FlowSolution end = march_flow(middle, inertial_drum(), spin_up(4, 4), one_mesh());
    EXPECT_TRUE(end.report.converged) << end.report.failure;
    return end.field.state();
  };
  const FlowSolution middle =
      ended(march_flow(flow_at_rest(inertial_drum(), one_mesh()), inertial_drum(), spin_up(4), one_mesh()));
  const FlowState kept = middle.field.state();
  const FlowState at_a_stretch = second_half(middle.field);
  EXPECT_EQ(flow_of_state(kept, inertial_drum(), one_mesh()).integrals().area, middle.field.integrals().area);
  const FlowState resumed = second_half(flow_of_state(kept, inertial_drum(), one_mesh()));
  ASSERT_EQ(resumed.values.size(), at_a_stretch.values.size());
  if (FemRuntime::ranks() == 1) {
    EXPECT_EQ(resumed.theta, at_a_stretch.theta);
    EXPECT_EQ(resumed.values, at_a_stretch.values);
  } else {  // sums over ranks come in the order of their messages
    EXPECT_NEAR(resumed.theta, at_a_stretch.theta, 1e-6);
  }
}

}  // namespace
}  // namespace drumlin::march
