// Newton steps of the few unknowns whose residuals stand out.
#include "continuum/fem/detail/local_steps.hpp"

#include <gtest/gtest.h>

#include "boxes.hpp"
#include "continuum/fem/detail/solved_level.hpp"
#include "continuum/fem/detail/step_length.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"

namespace drumlin::local_steps {
using namespace continuum;
namespace {

using namespace testing_boxes;
using fem::Discretisation;
using fem::SolvedLevel;
using fem::State;

/// Calls visit(index among those of this rank, place) for each velocity of this rank that may change.
template <class Visit>
void for_each_free_velocity(const Discretisation& d, Visit visit) {
  const auto places = fem::places_of_unknowns(d);
  for (std::size_t k = 0; k < d.is_velocity.size(); ++k) {
    const auto index = d.owned.nth_index_in_set(static_cast<unsigned int>(k));
    if (d.is_velocity[k] && !d.homogeneous.is_constrained(index)) visit(k, places.at(index));
  }
}

/// The state of a flow, with other velocities within `reach` of a place.
State disturbed(const SolvedLevel& level, dealii::Point<2> place, double reach) {
  State state = level.state;
  const Discretisation& d = *level.discretisation;
  for_each_free_velocity(d, [&](std::size_t k, dealii::Point<2> at) {
    if (at.distance(place) < reach) state.solution.local_element(k) += 0.02;
  });
  d.constraints.distribute(state.solution);
  state.solution.update_ghost_values();
  state.dual = fem::dual_of(d, level.setting.regularisation, state.solution);
  return state;
}

double residual_of(const SolvedLevel& level, const State& state, fem::System& system) {
  fem::assemble_residual(level.problem, *level.discretisation, level.setting, state, system);
  return system.residual.l2_norm();
}

double along(const dealii::Point<2>& a, const dealii::Point<2>& b) { return std::abs(a[0] - b[0]); }

/// Lets a disturbance settle; nothing may move beyond `far` from it, nor from where it is once more in a box
/// of this period, and what follows from other unknowns has to go on doing so.
void expect_that_it_settles(const FlowField& flow, dealii::Point<2> place, double reach, double far,
                            double period = INFINITY) {
  const SolvedLevel& level = flow.level();
  const Discretisation& d = *level.discretisation;
  const State before = disturbed(level, place, reach);
  fem::System system(d);
  const double undisturbed = residual_of(level, level.state, system);
  const double disturbance = residual_of(level, before, system);
  ASSERT_GT(disturbance, 1e3 * undisturbed);
  const auto settled = fem::locally_settled(level.problem, d, level.setting, before, system.residual);
  ASSERT_TRUE(settled);
  EXPECT_LT(residual_of(level, *settled, system), 0.2 * disturbance);
  double moved_far = 0;
  for_each_free_velocity(d, [&](std::size_t k, dealii::Point<2> at) {
    const double x = std::min(along(at, place), period - along(at, place));
    if (std::hypot(x, at[1] - place[1]) > far)
      moved_far += std::abs(settled->solution.local_element(k) - before.solution.local_element(k));
  });
  EXPECT_EQ(d.sum(moved_far), 0);
  fem::FieldVector held = settled->solution;
  d.constraints.distribute(held);
  held -= settled->solution;
  EXPECT_LT(held.l2_norm(), 1e-12);
  const auto dual = fem::dual_of(d, level.setting.regularisation, settled->solution);
  ASSERT_EQ(settled->dual.size(), dual.size());
  for (std::size_t k = 0; k < dual.size(); ++k) EXPECT_LE(magnitude(settled->dual[k]), 1 + 1e-12);
}

FlowSolverOptions meshes(int levels, double refined_share = 1) {
  FlowSolverOptions options;
  options.levels = levels;
  options.refined_share = refined_share;
  return options;
}

TEST(LocalSteps, SettleADisturbanceWhereItIs) {
  expect_that_it_settles(converged(small_drum_problem(paper_law, 1e-4), meshes(3)), {2, -4}, 0.6, 5);
}

TEST(LocalSteps, HoldHangingNodes) {
  const FlowField flow = converged(small_drum_problem(paper_law, 1e-4), meshes(3, 0.3));
  for (const dealii::Point<2> place : {dealii::Point<2>(2, -4), dealii::Point<2>(0, -1)})
    expect_that_it_settles(flow, place, 1.2, 9);
}

// Both sides of the box are one.
TEST(LocalSteps, HoldPeriodicSides) {
  FlowProblem problem;
  problem.domain = BoxDomain{.width = 24, .height = 12, .cells_x = 48, .cells_z = 24, .periodic_x = true};
  problem.law = paper_law;
  problem.density = 0.8;
  problem.slope = FixedSlope{0.33};
  problem.boundary[Side::bottom] = at_rest();
  problem.boundary[Side::top] = constant_traction(0, 0);
  const FlowField flow = converged(problem, one_mesh());
  for (const double x : {-12.0, 12.0, 3.0}) expect_that_it_settles(flow, {x, -5}, 0.6, 5, 24);
}

TEST(LocalSteps, LeaveAloneWhatIsFarOffEverywhere) {
  FlowProblem problem = strip(16, 32, paper_law, constant_traction(0, 0));
  problem.density = 1;
  const FlowField at_rest = flow_at_rest(problem);
  const SolvedLevel& level = at_rest.level();
  fem::System system(*level.discretisation);
  ASSERT_GT(residual_of(level, level.state, system), 0);
  EXPECT_FALSE(fem::locally_settled(level.problem, *level.discretisation, level.setting, level.state,
                                    system.residual));
}

// Without them the last mesh takes nine steps of all unknowns.
TEST(LocalSteps, SaveStepsOfAllUnknowns) {
  const FlowSolution flow = ended(solve_flow(small_drum_problem(paper_law, 1e-5), meshes(4)));
  int last_mesh = 0;
  for (const IterationReport& line : flow.report.history) last_mesh += line.level == 3;
  EXPECT_LE(last_mesh, 6);
  const auto local = std::find_if(flow.report.phases.begin(), flow.report.phases.end(),
                                  [](const PhaseSeconds& phase) { return phase.name == "local steps"; });
  ASSERT_NE(local, flow.report.phases.end());
  EXPECT_GT(local->times, 0);
}

// Where the wall has jumped, what stands out is a thin layer there, and settling it leads nowhere: 51 steps
// and more, forty of them in vain, before that was noticed; 11 to 16 without local steps.
TEST(LocalSteps, EndSoonWhereTheyLeadNowhere) {
  for (const double eps : {1e-3, 1e-5}) {
    const FlowField start = converged(small_drum_problem(paper_law, eps), meshes(3));
    for (const double share : {0.95, 1.3}) {
      DrumGeometry drum = small_drum();
      drum.rotation *= share;
      const FlowSolution again = ended(solve_flow_again(start, small_drum_problem(paper_law, eps, drum)));
      EXPECT_TRUE(again.report.failure.empty()) << again.report.failure;
      EXPECT_LE(again.report.iterations, 30) << eps << " " << share;
    }
  }
}

// The slope's equation is none of the residual's: local steps move the surface, too.
TEST(LocalSteps, LeaveNoMomentOnTheSurface) {
  FlowSolverOptions options = meshes(3);
  const FlowProblem problem = small_drum_problem(paper_law, 1e-4);
  const double exact = converged(problem, options).theta();
  options.tolerance = 1e-6;
  EXPECT_NEAR(converged(problem, options).theta(), exact, 1e-6);
}

TEST(StepLength, IsWholeWhereTheSlopeFalls) {
  EXPECT_EQ(fem::step_length(-1, [](double alpha) { return alpha - 1; }).share, 1);
  EXPECT_EQ(fem::step_length(-1, [](double) { return -2; }).share, 1);  // no change of sign
}

TEST(StepLength, SaysWhetherItAskedLastForWhatItReturns) {
  double asked = 0;
  const fem::StepLength never_well_below = fem::step_length(-1, [&](double share) {
    asked = share;
    return share < 0.2 ? -0.8 : 5 * share;
  });
  EXPECT_LT(never_well_below.share, 1);
  EXPECT_EQ(never_well_below.asked_last, asked == never_well_below.share);
  const fem::StepLength halved = fem::step_length(-1, [](double share) { return share > 0.5 ? NAN : 0.1; });
  EXPECT_EQ(halved.share, 0.5);
  EXPECT_TRUE(halved.asked_last);
}

}  // namespace
}  // namespace drumlin::local_steps
