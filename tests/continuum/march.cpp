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

// A layer of fluid that the slope sets going at time 0 and lets go after `begun`, at its surface.
struct Layer {
  static constexpr double height = 4, slope = 0.5, density = 0.8, viscosity = 3.2, begun = 2, end = 3;

  static double speed_of_start(double time) {
    if (time <= 0) return 0;
    const double scale = density * std::sin(slope) * height * height / viscosity;
    double sum = 0.5;
    for (int n = 0; n < 40; ++n) {
      const double k = (n + 0.5) * std::numbers::pi, decay = k * k * viscosity / (density * height * height);
      sum -= 2 * (n % 2 == 0 ? 1 : -1) / (k * k * k) * std::exp(-decay * time);
    }
    return scale * sum;
  }
  static double error(int steps_per_time) {
    FlowProblem problem = strip(height, 12, NewtonianLaw{viscosity}, constant_traction(0, 0));
    problem.density = density;
    problem.slope = FixedSlope{slope};
    const auto marched = [&](const FlowField& from, double time) {
      return ended(march_flow(from, problem,
                              {.time_step = 1.0 / steps_per_time,
                               .steps = static_cast<int>(std::lround(steps_per_time * time))}))
          .field;
    };
    const FlowField flowing = marched(flow_at_rest(problem, one_mesh()), begun);
    problem.slope = FixedSlope{0};
    const FlowField last = marched(flowing, end - begun);
    const double exact = speed_of_start(end) - speed_of_start(end - begun);
    return std::abs(state_at(last, {0.1, 0}).velocity.x / exact - 1);
  }
};

TEST(March, OfALayerThatStartsAndStopsIsOfSecondOrder) {
  expect_orders({Layer::error(2), Layer::error(4), Layer::error(8)}, {1.7, 1.7});
}

}  // namespace
}  // namespace drumlin::march
