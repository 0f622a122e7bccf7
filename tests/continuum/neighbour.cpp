// Starting from the state of another flow.
#include <algorithm>

#include "boxes.hpp"
#include "continuum/model/drum.hpp"
#include "coupling/core/basics/errors.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
using namespace continuum;
namespace {

using namespace testing_boxes;

FlowProblem drum_at(double rotation, double radius = 15) {
  const DrumGeometry drum{.radius = radius, .axis_offset = 1, .rotation = rotation, .nu = 0.82};
  return drum_problem(drum, LogLaw{0.35, 0.013}, {.surface_cell = 2, .surface_zone = 6, .levels = 2},
                      {.entrainment_length = 1}, {.shear_rate = 1e-3});
}

TEST(Neighbour, AnotherSpeedIsFoundInAFewIterations) {
  const FlowState slow = converged(drum_at(0.025), {}).state();
  const FlowSolution from = ended(solve_flow_from(slow, drum_at(0.03)));
  EXPECT_EQ(from.report.start, "neighbour");
  EXPECT_LE(from.report.iterations, 6);
  EXPECT_NEAR(from.field.theta(), converged(drum_at(0.03), {}).theta(), 1e-6);
}

TEST(Neighbour, IsKeptInTheOrderOfItsCells) {
  const FlowState state = converged(drum_at(0.03), {}).state();
  EXPECT_TRUE(std::is_sorted(state.cells.begin(), state.cells.end()));
  EXPECT_EQ(state.centres.size(), 2 * state.cells.size());
  EXPECT_EQ(state.values.size(), FlowState::values_per_cell * state.cells.size());
}

TEST(Neighbour, OfAnotherGeometryIsRefused) {
  const FlowState other = converged(drum_at(0.03, 22), {}).state();
  EXPECT_THROW((void)solve_flow_from(other, drum_at(0.03)), InputError);
}

TEST(Neighbour, ThatDoesNotServeGivesWayToAColdStart) {
  FlowState broken = converged(drum_at(0.03), {}).state();
  for (double& value : broken.values) value = 1e6 * std::sin(1e4 * value);
  FlowSolverOptions options;
  options.max_iterations = 12;
  const FlowSolution cold = ended(solve_flow_from(broken, drum_at(0.03), options));
  expect_has(cold.report.start, "cold, since from the neighbour");
  EXPECT_NEAR(cold.field.theta(), converged(drum_at(0.03), {}).theta(), 1e-6);
  EXPECT_EQ(cold.report.iterations, static_cast<int>(cold.report.history.size()));
}

}  // namespace
}  // namespace drumlin
