// Sweeps in strips: the plan keeps its promises, and neither threads nor the processor's vectors change a
// bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "particles/contact/problems.hpp"
#include "tests/particles/solving.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// Discs of a square lattice on a floor, each in contact with its right and upper neighbour, at random
/// velocities.
CoulombSpinProblem lattice(int columns, int rows, unsigned seed) {
  std::mt19937 bits(seed);
  const auto uniform = [&bits] { return 2 * static_cast<double>(bits()) / 4294967296.0 - 1; };
  CoulombSpinProblem problem;
  const int bodies = columns * rows;
  for (int b = 0; b < bodies; ++b) problem.W.inverse_mass.push_back(1 + 0.3 * uniform());
  problem.W.inverse_mass.push_back(0);
  const auto add = [&](int i, int j, double angle) {
    problem.W.add(i, j, std::cos(angle), std::sin(angle));
    problem.q.push_back(0.1 * uniform() - 0.05);
    problem.q.push_back(0.1 * uniform());
    problem.mu.push_back(0.4);
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int b = row * columns + column;
      if (row == 0) add(b, bodies, 1.5 + 0.1 * uniform());
      if (column + 1 < columns) add(b, b + 1, 3.1 + 0.1 * uniform());
      if (row + 1 < rows) add(b, b + columns, -1.5 + 0.1 * uniform());
    }
  return problem;
}

/// Bodies that the contacts of a slice touch, walls aside.
std::set<int> touched(const CoulombSpinProblem& p, const SweepPlan& plan, std::span<const std::int32_t> order,
                      int slice) {
  std::set<int> bodies;
  const int fixed = static_cast<int>(p.W.inverse_mass.size()) - 1;
  for (int k = plan.group_start[plan.slice_start[slice]]; k < plan.group_start[plan.slice_start[slice + 1]];
       ++k) {
    bodies.insert(p.W.i[order[k]]);
    if (p.W.j[order[k]] != fixed) bodies.insert(p.W.j[order[k]]);
  }
  return bodies;
}

TEST(SweepPlan, GroupsAndStripsOfAPhaseShareNoBody) {
  const auto problem = lattice(120, 60, 1);
  const int bodies = 120 * 60;
  std::vector<std::int32_t> order;
  const SweepPlan plan = sweep_plan(bodies, problem.W.i, problem.W.j, order);
  EXPECT_GE(plan.strips(), 4);
  EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), problem.W.i.size());
  EXPECT_EQ(std::set<int>(plan.body_order.begin(), plan.body_order.end()).size(),
            static_cast<std::size_t>(bodies));
  for (std::size_t g = 0; g + 1 < plan.group_start.size(); ++g) {
    std::set<int> seen;
    for (int k = plan.group_start[g]; k < plan.group_start[g + 1]; ++k) {
      EXPECT_TRUE(seen.insert(problem.W.i[order[k]]).second);
      if (problem.W.j[order[k]] < bodies) {
        EXPECT_TRUE(seen.insert(problem.W.j[order[k]]).second);
      }
    }
  }
  for (const int phase : {0, 1}) {
    std::set<int> seen;
    for (int strip = 0; strip < plan.strips(); ++strip)
      for (const int b : touched(problem, plan, order, 2 * strip + phase)) EXPECT_TRUE(seen.insert(b).second);
  }
  // In the first phase a strip touches no bodies but its own.
  for (int strip = 0; strip < plan.strips(); ++strip) {
    const std::set<int> own(plan.body_order.begin() + plan.strip_bodies[strip],
                            plan.body_order.begin() + plan.strip_bodies[strip + 1]);
    for (const int b : touched(problem, plan, order, 2 * strip)) EXPECT_TRUE(own.contains(b));
  }
}

TEST(SweepPlan, ABodyWithHundredsOfContactsGetsAsManyGroups) {
  std::vector<std::int32_t> i, j, order;
  for (int b = 1; b <= 300; ++b) i.push_back(0), j.push_back(b);
  const SweepPlan plan = sweep_plan(301, i, j, order);
  EXPECT_EQ(order.size(), 300u);
  EXPECT_EQ(plan.group_start.size(), 301u);
}

CoulombSpinProblem in_order_of(const CoulombSpinProblem& problem, const SweepPlan& plan,
                               std::span<const std::int32_t> order) {
  CoulombSpinProblem sorted;
  sorted.W.inverse_mass = problem.W.inverse_mass;
  for (const auto a : order) {
    sorted.W.add(problem.W.i[a], problem.W.j[a], problem.W.n_x[a], problem.W.n_z[a]);
    sorted.q.push_back(problem.q[2 * a]), sorted.q.push_back(problem.q[2 * a + 1]);
    sorted.mu.push_back(problem.mu[a]);
  }
  sorted.W.plan = plan;
  return sorted;
}

/// Single precision reaches 1e-4: where sweeps end with it, a tighter tolerance is not met.
TEST(Strips, SinglePrecisionThatRunsOutOfSweepsHasNotConverged) {
  auto unsorted = lattice(12, 8, 3);
  std::fill(unsorted.mu.begin(), unsorted.mu.end(), 0.05);  // sweeps do not converge with much friction
  std::vector<std::int32_t> order;
  const SweepPlan plan = sweep_plan(12 * 8, unsorted.W.i, unsorted.W.j, order);
  const auto problem = in_order_of(unsorted, plan, order);
  int missed = 0;
  for (const int sweeps : {50, 100, 200}) {
    const SolveReport report = solved_by("accelerated", problem, 1e-9, sweeps, nullptr, sweeps).report;
    EXPECT_EQ(report.status == Status::converged, report.residual.rms <= 1e-9) << sweeps;
    missed += report.residual.rms > 1e-9 && report.residual.rms < 1e-4;
  }
  EXPECT_GT(missed, 0);  // the case was met
}

/// The lattice with rolling resistance, its walls moved by forces, in the order of its plan.
RollingProblem rolling_lattice(int columns, int rows, bool driven) {
  const auto source = lattice(columns, rows, 4);
  std::vector<std::int32_t> order;
  const SweepPlan plan = sweep_plan(columns * rows, source.W.i, source.W.j, order);
  RollingProblem problem;
  auto& W = problem.W;
  W.inverse_mass = source.W.inverse_mass;
  if (driven) {
    W.driven = {{0.6, 0.8, 0.02}, {0, 1, 0.05}};
    W.inverse_mass.insert(W.inverse_mass.end(), 2, 0.0);
  }
  for (const auto a : order) {
    const bool wall = source.W.j[a] == columns * rows;
    const int moved = driven && wall ? 1 + source.W.i[a] % 2 : 0;
    W.add(source.W.i[a], source.W.j[a] + moved, source.W.n_x[a], source.W.n_z[a], wall ? 1 : 0.4);
    problem.q.insert(problem.q.end(), {source.q[2 * a], source.q[2 * a + 1], 0.5 * source.q[2 * a + 1]});
    problem.mu.insert(problem.mu.end(), {0.4, 0.1});
  }
  W.plan = plan;
  return problem;
}

template <class Problem>
void expect_as_in_turn(const Problem& problem) {
  const auto in_strips = solved_by("nlgs", problem, 0, 20).impulses;
  const auto scalar = solved_by("nlgs-scalar", problem, 0, 20).impulses;
  for (std::size_t k = 0; k < scalar.size(); ++k)
    ASSERT_NEAR(in_strips[k], scalar[k], 1e-12);  // rounding of 20 sweeps
}

TEST(Strips, SweepsAgreeWithThoseOfOneContactAfterTheOther) {
  // In the order of the plan both do the same sums; the vectorised form adds n.(v_i - v_j) in another order.
  auto problem = lattice(40, 30, 3);
  std::vector<std::int32_t> order;
  const SweepPlan plan = sweep_plan(40 * 30, problem.W.i, problem.W.j, order);
  expect_as_in_turn(in_order_of(problem, plan, order));
  expect_as_in_turn(rolling_lattice(40, 30, false));
}

template <class Problem>
void expect_same_bytes(const Problem& problem, std::initializer_list<const char*> solvers,
                       std::initializer_list<int> pools) {
  for (const char* solver : solvers) {
    const auto alone = solved_by(solver, problem, 0, 30).impulses;
    for (const int threads : pools) {
      ThreadPool pool(threads);
      EXPECT_EQ(alone, solved_by(solver, problem, 0, 30, &pool).impulses) << solver << ", " << threads;
    }
    on_each_instruction_set([&](const char* target) {
      EXPECT_EQ(alone, solved_by(solver, problem, 0, 30).impulses) << solver << " on " << target;
    });
  }
}

TEST(Strips, AnyThreadsAndInstructionSetGiveTheSameBytes) {
  const auto unsorted = lattice(150, 100, 2);
  std::vector<std::int32_t> order;
  const SweepPlan plan = sweep_plan(150 * 100, unsorted.W.i, unsorted.W.j, order);
  expect_same_bytes(in_order_of(unsorted, plan, order), {"nlgs", "accelerated", "accelerated-double", "cpg"},
                    {2, 3, 4, 8, 16});  // more than there are processors, too
  expect_same_bytes(rolling_lattice(100, 60, true), {"nlgs", "accelerated"}, {2, 3, 8});
}

TEST(Strips, DrivenWallsAndRollingConvergeAsOneContactAfterTheOtherDoes) {
  // Contacts of walls come last in strips: other sweeps, the same solution.
  auto problem = rolling_lattice(14, 10, true);
  std::fill(problem.mu.begin(), problem.mu.end(), 0.05);  // so that both converge
  std::vector<std::vector<double>> velocities;
  for (const char* solver : {"accelerated", "nlgs-scalar"}) {
    const auto solution = solved_by(solver, problem, 1e-7, 100000);
    EXPECT_EQ(solution.report.status, Status::converged) << solver;
    velocities.push_back(solution.velocities.contacts);
  }
  double worst = 0;
  for (std::size_t k = 0; k < velocities[0].size(); ++k)
    worst = std::max(worst, std::abs(velocities[0][k] - velocities[1][k]));
  EXPECT_LT(worst, 1e-5);  // of velocities of 0.1, at a residual of 1e-7
}

TEST(Strips, ASolveThatRunsOutReturnsTheBestThatItLookedAt) {
  const auto problem = lattice(60, 40, 5);
  for (const char* solver : {"accelerated", "accelerated-double", "nncg"}) {
    double best = std::numeric_limits<double>::infinity();
    for (int sweeps = 1; sweeps <= 81; sweeps += 4) {  // far away, each fourth residual is looked at
      const auto solution = solved_by(solver, problem, 0, sweeps, nullptr, 1);
      const SolveReport& report = solution.report;
      EXPECT_EQ(report.status, Status::out_of_sweeps);
      EXPECT_EQ(report.residual.rms, residual_at(problem, solution.impulses).rms);
      EXPECT_LE(report.residual.rms, best * 1.001)
          << solver << ", " << sweeps;  // estimates in single precision
      best = std::min(best, report.residual.rms);
    }
  }
}

}  // namespace
}  // namespace drumlin
