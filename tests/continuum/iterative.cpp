// Linear systems by iterations: the flow is that of MUMPS, and the iterations do not grow with the mesh.
#include "boxes.hpp"
#include "tests/hardcases/continuum/small_drum.hpp"

namespace drumlin {
using namespace continuum;
namespace {

using namespace testing_boxes;

FlowSolverOptions by(LinearMethod method, int levels) {
  FlowSolverOptions options;
  options.levels = levels;
  options.linear_method = method;
  return options;
}

TEST(IterativeSolver, HasTheFlowOfMumps) {
  const FlowProblem problem = small_drum_problem(paper_law, 1e-4);
  const FlowField direct = converged(problem, by(LinearMethod::direct, 2));
  const FlowSolution iterative = solve_flow(problem, by(LinearMethod::iterative, 2));
  ASSERT_TRUE(iterative.report.converged) << iterative.report.failure;
  // Both residuals are at most 1e-8 of the weight; along D the stress hardly resists, as 1/27 of across.
  EXPECT_NEAR(iterative.field.theta(), direct.theta(), 1e-7);
  const Vec2 below{0, -2};
  EXPECT_NEAR(state_at(iterative.field, below).velocity.x, state_at(direct, below).velocity.x, 1e-6);
  EXPECT_NEAR(state_at(iterative.field, below).pressure, state_at(direct, below).pressure, 1e-6);
}

TEST(IterativeSolver, TakesAsManyIterationsOnFinerMeshes) {
  const FlowSolution flow = solve_flow(small_drum_problem(paper_law, 1e-4), by(LinearMethod::iterative, 3));
  ASSERT_TRUE(flow.report.converged) << flow.report.failure;
  ASSERT_EQ(flow.report.linear.size(), 3u);
  EXPECT_FALSE(flow.report.linear[0].iterative);  // nothing coarser
  for (const int mesh : {1, 2}) {
    const LinearReport& linear = flow.report.linear[static_cast<std::size_t>(mesh)];
    EXPECT_TRUE(linear.iterative);
    EXPECT_EQ(linear.direct_instead, 0);
    EXPECT_GT(linear.solves, 0);
    EXPECT_LE(linear.most_iterations, 30) << mesh;  // the drum at 6 rpm: at most 16, to 1e-6
  }
  for (const IterationReport& line : flow.report.history) EXPECT_LE(line.linear_residual, 1e-6);
}

TEST(IterativeSolver, HoldsHangingNodesOfAdaptiveMeshes) {
  FlowSolverOptions options = by(LinearMethod::iterative, 3);
  options.refined_share = 0.3;
  const FlowSolution flow = solve_flow(small_drum_problem(paper_law, 1e-4), options);
  ASSERT_TRUE(flow.report.converged) << flow.report.failure;
  EXPECT_LE(flow.report.linear.back().most_iterations, 30);
}

TEST(IterativeSolver, ComesInBySizeAlone) {
  FlowSolverOptions options = by(LinearMethod::automatic, 2);
  EXPECT_FALSE(solve_flow(small_drum_problem(), options).report.linear.back().iterative);
  options.iterative_from = 1;
  EXPECT_TRUE(solve_flow(small_drum_problem(), options).report.linear.back().iterative);
}

TEST(IterativeSolver, ThatFailsSaysSo) {
  FlowSolverOptions options = by(LinearMethod::iterative, 2);
  options.most_linear_iterations = 1;
  const FlowSolution flow = solve_flow(small_drum_problem(), options);
  EXPECT_FALSE(flow.report.converged);
  EXPECT_NE(flow.report.failure.find("linear solve: true relative residual"), std::string::npos)
      << flow.report.failure;
}

TEST(IterativeSolver, ThatFailsGivesWayToMumpsWhereNobodyAskedForIt) {
  FlowSolverOptions options = by(LinearMethod::automatic, 2);
  options.iterative_from = 1;
  options.most_linear_iterations = 1;
  const FlowSolution flow = solve_flow(small_drum_problem(), options);
  ASSERT_TRUE(flow.report.converged) << flow.report.failure;
  const LinearReport& linear = flow.report.linear.back();
  EXPECT_GT(linear.direct_instead, 0);
  EXPECT_EQ(linear.most_iterations, 1);
  EXPECT_NEAR(flow.field.theta(), converged(small_drum_problem(), by(LinearMethod::direct, 2)).theta(), 1e-6);
}

// The tangent of a law with k is not symmetric in the axes of the stress: other systems than the drum's
// alone.
TEST(IterativeSolver, HasTheFlowOfMumpsWithNormalStressDifferences) {
  FlowProblem problem = small_drum_problem();
  problem.turned = TurnedStress{.k = StressRatioLaw({1e-3, 1e-1}, {0.93, 1.07})};
  const FlowField direct = converged(problem, by(LinearMethod::direct, 2));
  const FlowSolution iterative = solve_flow(problem, by(LinearMethod::iterative, 2));
  ASSERT_TRUE(iterative.report.converged) << iterative.report.failure;
  EXPECT_EQ(iterative.report.linear.back().direct_instead, 0);
  EXPECT_LE(iterative.report.linear.back().most_iterations, 60);
  EXPECT_NEAR(iterative.field.theta(), direct.theta(), 1e-5);  // Picard updates end at 1e-3
}

}  // namespace
}  // namespace drumlin
