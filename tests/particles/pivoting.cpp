// Contacts of steep friction solved by pivots, measured by the residual.
#include "particles/solver/pivoting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "particles/contact/problems.hpp"
#include "particles/lab/block_problem.hpp"
#include "particles/solver/contact_solver.hpp"
#include "tests/particles/solving.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// Of as many pivots as it takes.
std::vector<double> solved(const BlockProblem& problem) {
  const int size = 2 * problem.contacts();
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(size, size);
  for (int a = 0; a < problem.contacts(); ++a)
    for (int k = problem.W.row_start[a]; k < problem.W.row_start[a + 1]; ++k)
      W.block<2, 2>(2 * a, 2 * problem.W.column[k]) = problem.W.block[k];
  const auto r =
      solve_by_pivots(W, Eigen::Map<const Eigen::VectorXd>(problem.q.data(), size), problem.mu, 100000);
  EXPECT_TRUE(r);
  return r ? std::vector<double>(r->begin(), r->end()) : std::vector<double>(size, 0.0);
}

/// A disc of mass 1 with a velocity, on fixed walls with these normals.
CoulombSpinProblem disc_on_walls(const std::vector<std::array<double, 2>>& normals, double v_x, double v_z,
                                 double mu) {
  CoulombSpinProblem problem;
  problem.W.inverse_mass = {1, 0};
  for (const auto& [n_x, n_z] : normals) {
    problem.W.add(0, 1, n_x, n_z);
    problem.q.insert(problem.q.end(), {n_x * v_x + n_z * v_z, n_z * v_x - n_x * v_z});
    problem.mu.push_back(mu);
  }
  return problem;
}

TEST(Pivoting, DiscOnAPlaneSticksSlidesOrFlies) {
  // r_n = 1 stops the fall; r_t = -u_t / 3 stops the rim.
  const auto sticks = solved(block_problem(disc_on_walls({{0, 1}}, 1.5, -1, 10)));
  EXPECT_NEAR(sticks[0], 1, 2e-6);
  EXPECT_NEAR(sticks[1], -0.5, 2e-6);
  const auto slides = solved(block_problem(disc_on_walls({{0, 1}}, -1.5, -1, 0.2)));
  EXPECT_NEAR(slides[0], 1, 2e-6);
  EXPECT_NEAR(slides[1], 0.2, 2e-6);
  EXPECT_EQ(solved(block_problem(disc_on_walls({{0, 1}}, 1.5, 1, 10))), std::vector<double>(2, 0.0));
}

TEST(Pivoting, DiscWedgedBetweenUprightWallsHangsByFriction) {
  // Walls that close in by 1 press with any force; friction 2 carries the weight: no velocity is left.
  CoulombSpinProblem wedged = disc_on_walls({{1, 0}, {-1, 0}}, 0, -1, 2);
  for (const int n : {0, 2}) wedged.q[n] = 0;
  const BlockProblem problem = block_problem(wedged);
  EXPECT_LE(residual_of(problem, std::span<const double>(solved(problem))).rms, 1e-6);
}

/// Discs of masses near 1 in a lattice that closes in, with velocities at random: three contacts a disc, as
/// in packings of infinite friction.
CoulombSpinProblem packing(int side, double mu, unsigned seed) {
  std::mt19937 random(seed);
  const auto number = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
  CoulombSpinProblem problem;
  const int discs = side * side;
  std::vector<double> v_x(discs), v_z(discs);
  for (int k = 0; k < discs; ++k) {
    problem.W.inverse_mass.push_back(1 + 0.5 * number());
    v_x[k] = number() - k % side, v_z[k] = number() - k / side;
  }
  problem.W.inverse_mass.push_back(0);
  const auto touch = [&](int i, int j, double angle) {
    const double n_x = std::cos(angle), n_z = std::sin(angle);
    problem.W.add(i, j, n_x, n_z);
    const bool wall = j == discs;
    const double x = v_x[i] - (wall ? 0 : v_x[j]), z = v_z[i] - (wall ? 0 : v_z[j]);
    problem.q.insert(problem.q.end(), {n_x * x + n_z * z, n_z * x - n_x * z});
    problem.mu.push_back(mu);
  };
  for (int k = 0; k < discs; ++k) {
    const bool first = k % side == 0, lowest = k < side;
    if ((k + k / side) % 2 == 0) touch(k, first ? discs : k - 1, 0.3 * number());
    touch(k, lowest ? discs : k - side, 1.5708 + 0.3 * number());
  }
  return problem;
}

TEST(Pivoting, PackingsOfSteepFrictionAreSolved) {
  for (const unsigned seed : {1, 2, 3})
    for (const double mu : {0.3, 3.0, 100.0}) {
      const BlockProblem problem = block_problem(packing(5, mu, seed));
      EXPECT_LE(residual_of(problem, std::span<const double>(solved(problem))).rms, 1e-4) << mu;
    }
}

TEST(Pivoting, ASpoiltContactOfAPackingIsSettled) {
  const CoulombSpinProblem problem = packing(10, 0.9, 1);
  auto solution = solved_by("nlgs", problem, 1e-4, 20000);
  EXPECT_EQ(solution.report.status, Status::converged);
  solution.impulses[2 * 70] += 1;
  StoppingRule rule;
  EXPECT_GT(residual_of(problem, solution).rms, rule.tolerance);
  const SolveReport report = settle_clusters(problem, rule, solution);
  EXPECT_EQ(report.status, Status::converged) << report.residual.rms;
  EXPECT_LE(residual_of(problem, solution).rms, rule.tolerance);
  EXPECT_LE(report.sweeps, 20);
}

}  // namespace
}  // namespace drumlin
