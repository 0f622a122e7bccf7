// The coarse correction of large packings: it finds what all impulses lack in common, stays in the cones, and
// saves sweeps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "particles/contact/problems.hpp"
#include "particles/solver/coarse_kernels.hpp"
#include "particles/solver/contact_solver.hpp"
#include "particles/solver/strip_solver.hpp"
#include "tests/particles/solving.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// Discs of diameter 1 in a triangular lattice on a floor between two walls, under their weight, in the order
/// of a plan; with `slab` a heavy body lies on the whole of the highest row.
struct Heap {
  CoulombSpinProblem problem;
  std::vector<double> x, z;
};

Heap heap(int columns, int rows, double mu = 0.4, bool slab = false) {
  constexpr double time_step = 0.05;
  Heap heap;
  CoulombSpinProblem unsorted;
  const int discs = columns * rows, bodies = discs + slab;
  unsorted.W.inverse_mass.assign(bodies + 1, 1.0);
  unsorted.W.inverse_mass.back() = 0;
  if (slab) unsorted.W.inverse_mass[discs] = 1e-3;
  const auto add = [&](int i, int j, double n_x, double n_z) {
    unsorted.W.add(i, j, n_x, n_z);
    unsorted.q.push_back(j == bodies ? -time_step * n_z : 0), unsorted.q.push_back(0);
    unsorted.mu.push_back(mu);
  };
  const double up = std::sqrt(0.75);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const int b = row * columns + column, shift = row % 2;
      heap.x.push_back(column + 0.5 * shift), heap.z.push_back(0.5 + up * row);
      if (row == 0) add(b, bodies, 0, 1);
      if (column == 0 && shift == 0) add(b, bodies, 1, 0);
      if (column + 1 == columns && shift == 1) add(b, bodies, -1, 0);
      if (column + 1 < columns) add(b, b + 1, -1, 0);
      if (row + 1 == rows) continue;
      const int left = column + shift - 1;  // of the row above
      if (left >= 0) add(b, b + columns + left - column, 0.5, -up);
      if (left + 1 < columns) add(b, b + columns + left + 1 - column, -0.5, -up);
    }
  if (slab) {
    heap.x.push_back(0.5 * columns), heap.z.push_back(1 + up * rows);
    for (int b = discs - columns; b < discs; ++b) add(discs, b, 0, 1);
  }
  std::vector<std::int32_t> order;
  auto& sorted = heap.problem;
  sorted.W.plan = SweepPlan{};
  SweepPlanner().plan(body_slices_along(heap.x, unsorted.W.i, unsorted.W.j), unsorted.W.i, unsorted.W.j,
                      sorted.W.plan, order);
  sorted.W.inverse_mass = unsorted.W.inverse_mass;
  for (const auto a : order) {
    sorted.W.add(unsorted.W.i[a], unsorted.W.j[a], unsorted.W.n_x[a], unsorted.W.n_z[a]);
    sorted.q.push_back(unsorted.q[2 * a]), sorted.q.push_back(unsorted.q[2 * a + 1]);
    sorted.mu.push_back(unsorted.mu[a]);
  }
  sorted.time_step = time_step;
  return heap;
}

/// Impulses of a heap that have been scaled by 0.8 and corrected.
std::vector<double> corrected(const Heap& heap, std::vector<double> r, ThreadPool* pool) {
  const auto& W = heap.problem.W;
  ParallelLoops loops(pool);
  for (double& entry : r) entry *= 0.8;
  StripProblem<double, Coulomb, true> strips;
  strips.pack(heap.problem, W.plan, {}, r, loops);
  for (const int phase : {0, 1})
    for (int strip = 0; strip < strips.strips(); ++strip) strips.load(strip, phase);
  CoarseLoads coarse;
  coarse.lay_out(W.i, W.j, {heap.x, heap.z}, strips, loops);
  EXPECT_TRUE(coarse.scale(strips, loops));
  strips.unpack(heap.problem, false, r, loops);
  return r;
}

/// The impulses of a heap without friction (with it those of other loads are no multiples).
std::vector<double> impulses_of(const Heap& heap) {
  const auto solution = solved_by("accelerated-double", heap.problem, 1e-6, 20000);
  EXPECT_EQ(solution.report.status, Status::converged);
  return solution.impulses;
}

/// Impulses after a correction against solved ones, relative to the largest: the hats count as linear between
/// the bodies of a contact, which the few across the border of two cells show.
void expect_found(const std::vector<double>& r, const std::vector<double>& solved) {
  const double largest = *std::max_element(r.begin(), r.end());
  std::size_t near = 0;
  for (std::size_t k = 0; k < r.size(); ++k) {
    EXPECT_NEAR(r[k], solved[k], 3e-3 * largest);
    near += std::abs(r[k] - solved[k]) <= 1e-3 * largest;
  }
  EXPECT_GE(near, 0.998 * r.size());
}

TEST(CoarseLoads, FindWhatAllImpulsesLack) {
  const Heap small = heap(60, 40, 0);
  const auto solved = impulses_of(small), r = corrected(small, solved, nullptr);
  expect_found(r, solved);
  for (std::size_t a = 0; a < small.problem.mu.size(); ++a)
    EXPECT_LE(std::abs(r[2 * a + 1]), small.problem.mu[a] * r[2 * a] * (1 + 1e-12));
  for (const int threads : {2, 3, 5}) {
    ThreadPool pool(threads);
    EXPECT_EQ(corrected(small, solved, &pool), r) << threads;
  }
}

TEST(CoarseLoads, AreTheSameOnAnyInstructionSet) {
  const Heap small = heap(60, 40, 0);
  const auto solved = impulses_of(small), best = corrected(small, solved, nullptr);
  on_each_instruction_set(
      [&](const char* target) { EXPECT_EQ(best, corrected(small, solved, nullptr)) << target; });
}

TEST(CoarseLoads, SeeContactsOfBodiesThatAreFarApart) {
  const Heap small = heap(60, 40, 0, true);
  const auto solved = impulses_of(small), r = corrected(small, solved, nullptr);
  expect_found(r, solved);
}

/// To a residual of 1e-2 and a sinking of 1e-3 d, from these impulses.
SolveReport solved(const Heap& heap, bool with_places, Solution<CoulombSpinProblem>& solution) {
  SolverWorkspace<CoulombSpinProblem> work;
  if (with_places) work.places = {heap.x, heap.z};
  StoppingRule rule;
  rule.tolerance = 1e-2, rule.penetration = rule.sinking = 1e-3, rule.max_sweeps = 20000;
  return solve_accelerated(heap.problem, rule, work, solution);
}

TEST(CoarseLoads, SaveMostSweepsWhereTheLoadOfALargePackingChanges) {
  const Heap large = heap(260, 140);
  ASSERT_GE(large.problem.contacts(), least_contacts_of_coarse_loads);
  Solution<CoulombSpinProblem> at_rest;
  ASSERT_EQ(solved(large, true, at_rest).status, Status::converged);
  for (double& entry : at_rest.impulses) entry *= 0.8;
  Solution<CoulombSpinProblem> left_alone = at_rest;
  const SolveReport with = solved(large, true, at_rest), without = solved(large, false, left_alone);
  EXPECT_EQ(with.status, Status::converged);
  EXPECT_LE(2 * with.sweeps, without.sweeps);
}

TEST(CoarseLoads, LeaveSmallPackingsToTheSweeps) {
  const Heap small = heap(60, 40);
  Solution<CoulombSpinProblem> with, without;
  (void)solved(small, true, with), (void)solved(small, false, without);
  EXPECT_EQ(with.impulses, without.impulses);
}

}  // namespace
}  // namespace drumlin
