// A surface that moves: to where nothing presses on it, with all of the area.
#include "boxes.hpp"
#include "continuum/postprocessing/drum_profiles.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"
#include "tests/support/says.hpp"

namespace drumlin::surface_test {
using namespace continuum;
namespace {

using namespace testing_boxes;

constexpr double nu = 0.8, width = 20, depth = 8;

// Heights whose weight balances a force along x that is nu times their slope; no mean.
double wanted(double x) { return 0.6 * std::sin(1.5 * std::numbers::pi * x / width); }
double wanted_slope(double x) {
  return 0.6 * 1.5 * std::numbers::pi / width * std::cos(1.5 * std::numbers::pi * x / width);
}

FlowProblem pile_at_rest() {
  FlowProblem problem;
  problem.domain = BoxDomain{.width = width, .height = depth, .cells_x = 10, .cells_z = 4};
  problem.law = NewtonianLaw{1};
  problem.density = nu;
  problem.slope = FixedSlope{0};
  problem.regularisation = {.shear_rate = 1e-2, .pressure = 0.2};
  problem.extra_force = [](Vec2 p) { return Vec2{nu * wanted_slope(p.x), 0}; };
  problem.boundary[Side::top] = NormalSpring{1e4};
  for (const Side side : {Side::bottom, Side::left, Side::right}) problem.boundary[side] = at_rest();
  problem.moving_surface = MovingSurface{.degree = 9, .tolerance = 1e-3};
  return problem;
}

TEST(MovingSurface, TakesTheHydrostaticShapeWithItsEndsAtTheWall) {
  FlowSolverOptions options;
  options.levels = 2;
  const FlowSolution solution = ended(solve_flow(pile_at_rest(), options));
  ASSERT_TRUE(solution.field.surface());
  // At the right end 0.42, where pinned ends would leave nought.
  for (const double x : {-8.0, -5.0, -1.0, 3.0, 7.5})
    EXPECT_NEAR(height(*solution.field.surface(), x), wanted(x), 5e-3) << x;
  for (const double x : {-10.0, 10.0})  // what presses there counts less
    EXPECT_NEAR(height(*solution.field.surface(), x), wanted(x), 2e-2) << x;
  EXPECT_NEAR(solution.field.integrals().area / (width * depth), 1, 1e-5);  // of quadratic cells
  // Nothing moves, so that p is the weight of what stands above.
  for (const Vec2 p : {Vec2{-5, -2}, Vec2{4, -6}, Vec2{1, -0.5}})
    EXPECT_NEAR(state_at(solution.field, p).pressure, nu * (wanted(p.x) - p.z), 5e-3) << p.x;
  // What presses answers to the heights linearly here, and a wave of pressure to one wave: one step of
  // Newton's method per mesh.
  EXPECT_LE(solution.report.surface_steps.size(), 5u);
}

TEST(MovingSurface, SaysThatItDidNotSettle) {
  FlowProblem problem = pile_at_rest();
  problem.moving_surface->max_steps = 0;
  const FlowSolution solution = solve_flow(problem, one_mesh());
  EXPECT_FALSE(solution.report.converged);
  expect_has(solution.report.failure, "moving surface");
}

TEST(MovingSurface, RefusesAShapeThatWouldTurnCellsInsideOut) {
  FlowProblem problem = pile_at_rest();
  problem.extra_force = [](Vec2 p) { return Vec2{20 * nu * wanted_slope(p.x), 0}; };  // 12 d of a depth of 8
  const FlowSolution solution = solve_flow(problem, one_mesh());
  EXPECT_FALSE(solution.report.converged);
  expect_has(solution.report.failure, "moving surface");
}

FlowProblem small_drum_with_surface(double cell) {
  const DrumGeometry drum = drumlin::small_drum();
  FlowProblem problem =
      drum_problem(drum, LogLaw{0.35, 0.013}, {.surface_cell = cell, .surface_zone = 6, .levels = 1},
                   {.entrainment_length = 1}, {.shear_rate = 1e-3});
  problem.moving_surface = MovingSurface{.degree = 6,
                                         .tolerance = 0.03,
                                         .slope_half_length = 0.5 * drum.half_chord(),
                                         .wall_velocity = [drum](Vec2 point, Vec2 left, Vec2 right) {
                                           return entraining_wall_velocity(drum, 1, point, left, right);
                                         }};
  return problem;
}

TEST(MovingSurface, OfADrumKeepsItsFillAndItsBalances) {
  const DrumGeometry drum = drumlin::small_drum();
  const FlowSolution solution = ended(solve_flow(small_drum_with_surface(1), one_mesh()));
  const SurfaceShape& shape = *solution.field.surface();
  EXPECT_NEAR(solution.field.integrals().area / segment_area(drum.radius, drum.axis_offset), 1, 1e-4);
  EXPECT_NEAR(mean_slope(shape, 0.5 * drum.half_chord()), 0, 1e-12);
  EXPECT_GT(largest_height(shape), 0.3);
  const auto& steps = solution.report.surface_steps;
  EXPECT_LT(steps.back().resolved, 0.03);
  EXPECT_GT(steps.front().resolved, 0.3);
  // The rest is in the cells next to the ends.
  EXPECT_LT(steps.back().rms, 0.7 * steps.front().rms);
  EXPECT_LE(steps.size(), 8u);
  const ScalarSet checks = drum_checks(solution.field, drum);
  EXPECT_NEAR(checks.value("Q_relative_error"), 0, 1e-3);
  EXPECT_LT(checks.value("flux_imbalance"), 1e-3);
  EXPECT_NEAR(checks.value("torque_relative_error"), 0, 1e-4);
  EXPECT_NEAR(checks.value("power_relative_error"), 0, 1e-3);
}

TEST(MovingSurface, StartsAsHighAsTheSpeedOfItsNeighbourSays) {
  FlowProblem slow = small_drum_with_surface(2);
  slow.inertia = Inertia{};
  FlowProblem fast = slow;
  const auto velocity = slow.moving_surface->wall_velocity;
  fast.moving_surface->wall_velocity = [velocity](Vec2 point, Vec2 left, Vec2 right) {
    const Vec2 v = velocity(point, left, right);
    return Vec2{1.2 * v.x, 1.2 * v.z};
  };
  const FlowField first = converged(slow, one_mesh());
  const FlowSolution from = ended(solve_flow_from(first.state(), fast, one_mesh()));
  EXPECT_NEAR(from.report.surface_steps.front().height, 1.44 * largest_height(*first.surface()), 1e-6);
}

TEST(MovingSurface, StartsWhereThatOfANeighbourIs) {
  const FlowProblem problem = small_drum_with_surface(2);
  const FlowField first = converged(problem, one_mesh());
  const FlowSolution again = ended(solve_flow_from(first.state(), problem, one_mesh()));
  for (const SurfaceStepReport& step : again.report.surface_steps)
    EXPECT_EQ(step.share, 0);  // nothing is left to move
  EXPECT_NEAR(again.field.theta(), first.theta(), 1e-9);
  // A flow that holds its surface takes the numbers and none of the shape.
  FlowProblem held = problem;
  held.moving_surface = std::nullopt;
  const FlowSolution flat = ended(solve_flow_from(first.state(), held, one_mesh()));
  EXPECT_FALSE(flat.field.surface());
  EXPECT_TRUE(flat.report.surface_steps.empty());
  EXPECT_NEAR(flat.field.theta(), converged(held, one_mesh()).theta(), 1e-6);
}

}  // namespace
}  // namespace drumlin::surface_test
