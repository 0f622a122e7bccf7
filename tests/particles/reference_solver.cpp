// The reference solver where sweeps alone do not get there, and its linear systems.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "particles/lab/block_problem.hpp"
#include "particles/lab/disc_problem.hpp"
#include "particles/lab/proximal_newton.hpp"
#include "particles/lab/reference_linear.hpp"
#include "particles/lab/sparse_lu.hpp"
#include "tests/particles/solving.hpp"

namespace drumlin::reference_solver {
using namespace particles;
using namespace test;
namespace {

class Random {
 public:
  explicit Random(unsigned seed) : bits_(seed) {}
  double operator()() { return static_cast<double>(bits_()) / 4294967296.0; }

 private:
  std::mt19937 bits_;
};

/// A triangular packing of equal discs (rows wide and high) on a floor, between two walls, pressed by
/// gravity: every grain is held by more contacts than it needs.
template <class Problem>
Problem crystal(int wide, int high, double mu, double mass_ratio = 1) {
  Problem problem;
  const int discs = wide * high, fixed = discs;
  for (int b = 0; b < discs; ++b) problem.W.inverse_mass.push_back(b % 3 == 0 ? 1 / mass_ratio : 1.0);
  problem.W.inverse_mass.push_back(0);
  const double c = 0.5, s = std::sqrt(3.0) / 2, g_h = 0.05;
  const auto add = [&](int i, int j, double n_x, double n_z) {
    problem.W.add(i, j, n_x, n_z);
    const bool falls_on_wall = j == fixed;
    problem.q.push_back(falls_on_wall ? -g_h * n_z : 0);
    if (Problem::dim == 2) {
      problem.q.push_back(falls_on_wall ? g_h * n_x : 0);
      problem.mu.push_back(mu);
    }
  };
  for (int row = 0; row < high; ++row)
    for (int k = 0; k < wide; ++k) {
      const int b = row * wide + k;
      if (k > 0) add(b, b - 1, 1, 0);
      if (row == 0) add(b, fixed, 0, 1);
      if (k == 0 && row % 2 == 0) add(b, fixed, 1, 0);
      if (k == wide - 1 && row % 2 == 1) add(b, fixed, -1, 0);
      if (row == 0) continue;
      const int below = b - wide, left = row % 2 == 1 ? below : below - 1;
      if (left / wide == row - 1 && left >= 0) add(b, left, c, s);
      if ((left + 1) / wide == row - 1) add(b, left + 1, -c, s);
    }
  return problem;
}

template <class Problem>
class Response : public ::testing::Test {};
using AllProblems = ::testing::Types<FrictionlessProblem, CoulombProblem, CoulombSpinProblem>;
TYPED_TEST_SUITE(Response, AllProblems);

/// y - (1 + D W) x, largest entry.
template <class Problem>
double fault(const Problem& problem, std::span<const ContactResponse> D, const std::vector<double>& y,
             const std::vector<double>& x) {
  constexpr int dim = Problem::dim;
  typename Problem::Delassus::State scratch;
  std::vector<double> u;
  const std::vector<double> zero(y.size(), 0.0);
  problem.W.velocities(x, zero, scratch, u);
  double largest = 0;
  for (int a = 0; a < problem.contacts(); ++a) {
    largest = std::max(largest, std::abs(y[dim * a] - x[dim * a] - D[a].nn * u[dim * a]));
    if (dim == 2)
      largest = std::max(largest,
                         std::abs(y[2 * a + 1] - x[2 * a + 1] - D[a].tn * u[2 * a] - D[a].tt * u[2 * a + 1]));
  }
  return largest;
}

TYPED_TEST(Response, BodiesAndBlocksSolveTheirSystems) {
  const auto problem = crystal<TypeParam>(5, 4, 0.4, 1e3);
  Random random(3);
  std::vector<ContactResponse> D(problem.contacts());
  std::vector<double> y(problem.q.size());
  for (auto& d : D) {
    const double kind = random();
    d.nn = kind < 0.2 ? 0 : 50;
    if (TypeParam::dim == 2 && d.nn > 0) (kind < 0.5 ? d.tt : d.tn) = kind < 0.5 ? 20 : 0.4 * d.nn;
  }
  for (double& value : y) value = random() - 0.5;
  ResponseSystem<typename TypeParam::Delassus> bodies(problem.W);
  for (int again = 0; again < 2; ++again)  // the second time with the pattern known
    EXPECT_LE(fault(problem, D, y, bodies.solution(D, y)), 1e-11);
  const BlockProblem blocks = block_problem(problem);
  ResponseSystem<BlockDelassus> contacts(blocks.W);
  const auto wide = block_layout<TypeParam>(y);
  EXPECT_LE(fault(blocks, D, wide, contacts.solution(D, wide)), 1e-11);
}

template <class Problem>
SolveReport solved(const Problem& problem, int max_sweeps, double tolerance, std::vector<double>& r) {
  const auto solution = solved_by("reference", problem, tolerance, max_sweeps);
  r = solution.impulses;
  return solution.report;
}

TEST(Reference, SolvesAHyperstaticCrystalInFewNewtonSteps) {
  for (const double mu : {0.1, 0.4, 0.95}) {
    const auto problem = crystal<CoulombSpinProblem>(12, 8, mu);
    std::vector<double> r, s;
    // 50 accelerated sweeps, 25 plain ones and up to 25 Newton steps. Rounding errors end near 1e-10.
    const auto report = solved(problem, 100, 1e-9, r);
    EXPECT_LE(report.residual.rms, 1e-9) << mu;
    const auto blocks = solved(block_problem(problem), 100, 1e-9, s);
    EXPECT_LE(blocks.residual.rms, 1e-9) << mu;
  }
}

TEST(Reference, FrictionlessAndSpinlessProblemsToo) {
  std::vector<double> r, s;
  EXPECT_LE(solved(crystal<FrictionlessProblem>(12, 8, 0), 200, 1e-9, r).residual.rms, 1e-9);
  EXPECT_LE(solved(crystal<CoulombProblem>(12, 8, 0.3), 200, 1e-9, s).residual.rms, 1e-9);
}

TEST(Reference, MassRatiosOfAThousand) {
  std::vector<double> r;
  EXPECT_LE(solved(crystal<CoulombSpinProblem>(6, 6, 0.4, 1e3), 2000, 1e-8, r).residual.rms, 1e-8);
}

template <class Problem>
SolveReport accelerated(const Problem& problem, const StoppingRule& rule) {
  SolverWorkspace<Problem> work;
  Solution<Problem> solution;
  return any_solver<Problem>("accelerated")(problem, rule, work, solution);
}

TEST(Reference, IsNeverWorseThanItsStart) {
  const auto problem = crystal<CoulombSpinProblem>(20, 20, 0.4);
  for (const int sweeps : {1, 2, 7, 30}) {
    StoppingRule rule;
    rule.tolerance = 0;
    rule.max_sweeps = std::max(1, sweeps / 2);
    std::vector<double> s;
    const auto start = accelerated(problem, rule);
    EXPECT_LE(solved(problem, sweeps, 0, s).residual.rms, start.residual.rms);
  }
}

TEST(Reference, ReturnsTheBestIterateThatItHasSeen) {
  const auto problem = crystal<CoulombSpinProblem>(8, 8, 0.6, 1e3);
  std::vector<double> best, first;
  const auto to_the_end = solved(problem, 200, 0, best);
  EXPECT_EQ(to_the_end.sweeps, 200);
  EXPECT_EQ(to_the_end.residual.rms, residual_at(problem, best).rms);
  // Stopped where it first sees this residual, it is where the other run was best, to the last byte.
  const auto stopped = solved(problem, 200, to_the_end.residual.rms, first);
  EXPECT_EQ(stopped.status, Status::converged);
  EXPECT_EQ(first, best);
}

TEST(Reference, FactorisesNothingWhenItsTimeIsUp) {
  const auto problem = crystal<CoulombSpinProblem>(12, 8, 0.4);
  StoppingRule rule;
  rule.tolerance = 0;
  rule.max_seconds = 0;
  SolverWorkspace<CoulombSpinProblem> work;
  Solution<CoulombSpinProblem> solution;
  const auto report = any_solver<CoulombSpinProblem>("reference")(problem, rule, work, solution);
  EXPECT_EQ(report.status, Status::out_of_time);
  EXPECT_EQ(report.sweeps, accelerated(problem, rule).sweeps);  // a factorisation counts as a sweep
}

TEST(Reference, AsksBeforeEachFactorisation) {
  const auto problem = crystal<CoulombSpinProblem>(12, 8, 0.4);
  ProximalNewton<CoulombSpinProblem> newton(problem);
  const std::vector<double> nothing(problem.q.size(), 0.0);
  int calls = 0;
  ASSERT_TRUE(newton.step(nothing, 10, [&] { return ++calls > 0; }));
  ASSERT_GT(calls, 2);
  EXPECT_EQ(newton.factorisations(), calls);
  int left = 2;
  EXPECT_FALSE(newton.step(nothing, 10, [&] { return left-- > 0; }));
  EXPECT_EQ(newton.factorisations(), 2);
}

TEST(SparseLu, SolvesBothWaysAndRefusesSingularMatrices) {
  const SparsePattern pattern{{0, 2, 4}, {0, 1, 0, 1}};
  SparseLu lu(pattern);
  ASSERT_TRUE(lu.factorise({1, 3, 2, 4}));  // rows (1 2), (3 4)
  std::vector<double> x(2);
  lu.solve(std::vector<double>{5, 11}, x);
  EXPECT_NEAR(x[0], 1, 1e-14);
  EXPECT_NEAR(x[1], 2, 1e-14);
  lu.solve_transposed(std::vector<double>{7, 10}, x);
  EXPECT_NEAR(x[0], 1, 1e-14);
  EXPECT_NEAR(x[1], 2, 1e-14);
  EXPECT_FALSE(lu.factorise({1, 2, 2, 4}));
  EXPECT_FALSE(lu.factorise({1, std::nan(""), 2, 4}));
}

TEST(DiscProblem, IsFoundInTheMatrixOfDiscs) {
  // Rings of three discs that touch one another, equal masses and masses 1:1000, walls.
  for (const double ratio : {1.0, 1e3}) {
    const auto discs = crystal<CoulombSpinProblem>(6, 5, 0.4, ratio);
    const BlockProblem blocks = block_problem(discs);
    const auto found = disc_problem(blocks);
    ASSERT_TRUE(found) << ratio;
    ASSERT_EQ(found->contacts(), discs.contacts());
    Random random(7);
    std::vector<double> r(discs.q.size());
    for (double& value : r) value = random() - 0.5;
    std::vector<double> u, v;
    CoulombSpinProblem::Delassus::State state;
    BlockDelassus::State none;
    found->W.velocities(r, found->q, state, u);
    blocks.W.velocities(r, blocks.q, none, v);
    for (std::size_t k = 0; k < u.size(); ++k) EXPECT_NEAR(u[k], v[k], 1e-12) << ratio << ' ' << k;
  }
}

TEST(DiscProblem, IsNotFoundWhereThereIsNone) {
  BlockProblem blocks = block_problem(crystal<CoulombSpinProblem>(6, 5, 0.4));
  blocks.W.block[1] *= 1.001;
  EXPECT_FALSE(disc_problem(blocks));
  EXPECT_FALSE(disc_problem(block_problem(crystal<CoulombProblem>(6, 5, 0.4))));  // that do not turn
  EXPECT_FALSE(disc_problem(block_problem(crystal<FrictionlessProblem>(6, 5, 0))));
}

}  // namespace
}  // namespace drumlin::reference_solver
