// One suite for every contact solver, measured by the residual that none of them computes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "coupling/core/basics/errors.hpp"
#include "particles/contact_law/coulomb_coupled.hpp"
#include "particles/lab/block_problem.hpp"
#include "tests/particles/solving.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

constexpr double g_h = 0.05;  // velocity that gravity gives in a step

class Solver : public ::testing::TestWithParam<std::string> {
 protected:
  template <class Problem>
  std::vector<double> solved(const Problem& problem, double tolerance = 1e-10) const {
    const Solved<Problem> solution = solved_by(GetParam(), problem, tolerance, 200000);
    const SolveReport& report = solution.report;
    EXPECT_EQ(report.status, Status::converged) << report.residual.rms << " after " << report.sweeps;
    EXPECT_LE(residual_at(problem, solution.impulses).rms, tolerance);
    return solution.impulses;
  }
};

/// Equal discs of mass 1 one above the other on a floor; contact k between disc k - 1 and k.
template <class Problem>
Problem column(int discs, double mu) {
  constexpr int dim = Problem::dim;
  Problem problem;
  problem.W.inverse_mass.assign(discs, 1.0);
  problem.W.inverse_mass.push_back(0);
  for (int k = 0; k < discs; ++k) {
    problem.W.add(k, k == 0 ? discs : k - 1, 0, 1);
    problem.q.push_back(k == 0 ? -g_h : 0);
    if (dim == 2) problem.q.push_back(0), problem.mu.push_back(mu);
  }
  return problem;
}

TEST_P(Solver, StackOfTenCarriesItsOwnWeight) {
  const auto r = solved(column<CoulombSpinProblem>(10, 0.4));
  for (int k = 0; k < 10; ++k) {
    EXPECT_NEAR(r[2 * k], (10 - k) * g_h, 1e-8) << k;
    EXPECT_NEAR(r[2 * k + 1], 0, 1e-12) << k;
  }
}

TEST_P(Solver, FrictionlessStackHasOneUnknownPerContact) {
  const auto r = solved(column<FrictionlessProblem>(10, 0));
  ASSERT_EQ(r.size(), 10u);
  for (int k = 0; k < 10; ++k) EXPECT_NEAR(r[k], (10 - k) * g_h, 1e-8) << k;
}

TEST_P(Solver, DiscInAWedgeStaysAtRest) {
  // Walls at 45 degrees, mu = 1.2 >= tan 45: velocity 0 whatever the (not unique) forces.
  CoulombSpinProblem problem;
  problem.W.inverse_mass = {1, 0};
  const double c = std::sqrt(0.5);
  problem.W.add(0, 1, c, c);
  problem.W.add(0, 1, -c, c);
  const double w_x = 0, w_z = -g_h;
  for (int a = 0; a < 2; ++a) {
    problem.q.push_back(problem.W.n_x[a] * w_x + problem.W.n_z[a] * w_z);
    problem.q.push_back(problem.W.n_z[a] * w_x - problem.W.n_x[a] * w_z);
    problem.mu.push_back(1.2);
  }
  const auto r = solved(problem);
  CoulombSpinProblem::Delassus::State state;
  problem.W.load(state, r);
  EXPECT_NEAR(w_x + state[0].x, 0, 1e-9);
  EXPECT_NEAR(w_z + state[0].z, 0, 1e-9);
  EXPECT_NEAR(state[0].s, 0, 1e-9);
  EXPECT_LT(std::abs(r[0]) + std::abs(r[2]), 10 * g_h);
}

/// Discs in contact at random. q comes from velocities of the bodies: rest is then admissible, a solution
/// exists.
CoulombSpinProblem random_problem(int bodies, int contacts, double mu, unsigned seed) {
  std::mt19937 bits(seed);
  const auto uniform = [&bits] { return static_cast<double>(bits()) / 4294967296.0; };
  CoulombSpinProblem problem;
  CoulombSpinProblem::Delassus::State velocity(bodies + 1);
  for (int b = 0; b < bodies; ++b) {
    problem.W.inverse_mass.push_back(0.5 + uniform());
    velocity[b] = {2 * uniform() - 1, 2 * uniform() - 1, 2 * uniform() - 1, 0};
  }
  problem.W.inverse_mass.push_back(0);
  for (int a = 0; a < contacts; ++a) {
    const int i = static_cast<int>(bits() % bodies);
    const int j = a % 4 == 0 ? bodies : static_cast<int>((i + 1 + bits() % (bodies - 1)) % bodies);
    const double angle = 6.283185307179586 * uniform();
    problem.W.add(i, j, std::cos(angle), std::sin(angle));
    const auto u = problem.W.relative_velocity(velocity, a);
    problem.q.insert(problem.q.end(), u.begin(), u.end());
    problem.mu.push_back(mu);
  }
  return problem;
}

TEST_P(Solver, RandomProblemsReachTheirTolerance) {
  for (unsigned seed = 1; seed <= 5; ++seed) solved(random_problem(30, 40, 0.3, seed), 1e-8);
}

TEST_P(Solver, BodiesAndBlocksAreTheSameProblem) {
  const auto problem = random_problem(20, 25, 0.3, 7);
  const auto blocks = block_problem(problem);
  const auto r = solved(problem);
  EXPECT_LE(residual_at(blocks, r).rms, 1e-9);
  const auto s = solved(blocks);
  EXPECT_LE(residual_at(problem, s).rms, 1e-9);
}

TEST_P(Solver, WhatRunsOutOfSweepsSaysSoLiesInTheConeAndHasItsVelocities) {
  const auto problem = random_problem(30, 60, 0.3, 3);
  for (const int sweeps : {3, 17, 40}) {
    const auto solution = solved_by(GetParam(), problem, 0, sweeps);
    const std::vector<double>& r = solution.impulses;
    EXPECT_EQ(solution.report.status, Status::out_of_sweeps);
    EXPECT_EQ(solution.report.sweeps, sweeps);
    EXPECT_EQ(solution.report.residual.rms, residual_at(problem, r).rms);
    for (int a = 0; a < problem.contacts(); ++a) {
      EXPECT_GE(r[2 * a], 0);
      EXPECT_LE(std::abs(r[2 * a + 1]), 0.3 * r[2 * a] * (1 + 1e-15));
    }
    Velocities<CoulombSpinProblem::Delassus> expected;
    problem.W.velocities(r, problem.q, expected.bodies, expected.contacts);
    EXPECT_EQ(solution.velocities.contacts, expected.contacts);
    ASSERT_EQ(solution.velocities.bodies.size(), expected.bodies.size());
    for (std::size_t b = 0; b < expected.bodies.size(); ++b) {
      EXPECT_EQ(solution.velocities.bodies[b].x, expected.bodies[b].x);
      EXPECT_EQ(solution.velocities.bodies[b].z, expected.bodies[b].z);
      EXPECT_EQ(solution.velocities.bodies[b].s, expected.bodies[b].s);
    }
  }
}

TEST_P(Solver, NotANumberIsReported) {
  auto problem = random_problem(5, 6, 0.3, 5);
  problem.q[3] = std::nan("");
  EXPECT_EQ(solved_by(GetParam(), problem, 1e-2, 100).report.status, Status::not_finite);
}

TEST_P(Solver, AWorkspaceCarriesNothingFromOneProblemToTheNext) {
  const auto first = random_problem(50, 90, 0.6, 9), second = random_problem(30, 60, 0.3, 10);
  StoppingRule rule;
  rule.max_sweeps = 25;
  rule.tolerance = 0;
  const auto solve = any_solver<CoulombSpinProblem>(GetParam());
  SolverWorkspace<CoulombSpinProblem> used, fresh;
  Solution<CoulombSpinProblem> before, with_used, with_fresh;
  (void)solve(first, rule, used, before);
  (void)solve(second, rule, used, with_used);
  (void)solve(second, rule, fresh, with_fresh);
  EXPECT_EQ(with_used.impulses, with_fresh.impulses);
  EXPECT_EQ(with_used.velocities.contacts, with_fresh.velocities.contacts);
}

INSTANTIATE_TEST_SUITE_P(Every, Solver, ::testing::ValuesIn(any_solver_names()), [](const auto& test) {
  std::string name = test.param;  // letters and underscores only
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(ContactSolver, AccelerationSavesMostSweepsOnATallColumn) {
  // Information travels one contact per sweep of NLGS: some N^2 sweeps; accelerated methods need some N.
  const auto sweeps = [](const char* solver, int discs) {
    const auto report = solved_by(solver, column<CoulombSpinProblem>(discs, 0.4), 1e-6, 100000).report;
    EXPECT_EQ(report.status, Status::converged);
    return report.sweeps;
  };
  for (const char* accelerated : {"accelerated", "nncg"})
    EXPECT_LT(5 * sweeps(accelerated, 100), sweeps("nlgs", 100)) << accelerated;
  for (const int discs : {100, 300})
    EXPECT_LE(sweeps("accelerated-double", discs), 20 * discs);  // measured: 10
}

TEST(ContactSolver, UnknownNameIsRefusedWithTheKnownOnes) {
  EXPECT_THROW(any_solver<CoulombSpinProblem>("magic"), InputError);
}

TEST(PlanarContact, EveryCaseSatisfiesItsLaws) {
  std::mt19937 bits(11);
  const auto uniform = [&bits] { return 2 * static_cast<double>(bits()) / 4294967296.0 - 1; };
  for (int k = 0; k < 2000; ++k) {
    Eigen::Matrix2d W;
    W << 1, 0.3 * uniform(), 0, 3;
    W(1, 0) = W(0, 1);
    const Eigen::Vector2d q(uniform(), uniform());
    const double mu = 0.5 * (uniform() + 1);
    const Eigen::Vector2d r = solve_planar_contact(W, q, mu), u = W * r + q;
    EXPECT_GE(r[0], 0);
    EXPECT_LE(std::abs(r[1]), mu * r[0] + 1e-14);
    EXPECT_GE(u[0], -1e-14);
    EXPECT_NEAR(u[0] * r[0], 0, 1e-13);
    if (std::abs(r[1]) < mu * r[0] - 1e-12)
      EXPECT_NEAR(u[1], 0, 1e-13);
    else
      EXPECT_LE(u[1] * r[1], 1e-13);
  }
}

}  // namespace
}  // namespace drumlin
