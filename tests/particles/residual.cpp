// The residual itself: hand-made problems whose residual is known.
#include "particles/contact/residual.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <limits>

#include "particles/contact/problems.hpp"
#include "particles/lab/block_delassus.hpp"

namespace drumlin {
using namespace particles;
namespace {

/// One disc of mass m on a fixed floor, approaching with q.
CoulombSpinProblem disc_on_floor(double q_n, double q_t, double mu, double mass = 2) {
  CoulombSpinProblem problem;
  problem.W.inverse_mass = {1 / mass, 0};
  problem.W.add(0, 1, 0, 1);
  problem.q = {q_n, q_t};
  problem.mu = {mu};
  problem.time_step = 0.1;
  return problem;
}

ContactResidual residual(const CoulombSpinProblem& problem, std::vector<double> r) {
  return residual_of(problem, std::span<const double>(r));
}

TEST(Residual, OnVectorsIsThatOfTheContactsOneByOne) {
  // 1 / W_nn, mu, r and u of contacts that are open, slide, stick, or have no friction; some vectors and a
  // rest.
  constexpr std::size_t contacts = 45;
  std::vector<double> inverse_W_nn, mu, r, u;
  for (std::size_t k = 0; k < contacts; ++k) {
    const double s = static_cast<double>(k);
    inverse_W_nn.push_back(0.5 + 0.01 * s);
    mu.push_back(k % 3 == 0 ? 0 : k % 7 == 0 ? 30 : 0.1 * static_cast<double>(k % 5));
    r.insert(r.end(), {k % 4 == 0 ? 0 : std::abs(std::sin(5 * s)), k % 4 == 0 ? 0 : 0.3 * std::sin(11 * s)});
    u.insert(u.end(), {std::sin(7 * s), k % 6 == 0 ? 0 : std::cos(3 * s)});
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  mu[20] = nan, u[2 * 11] = nan, u[2 * 12 + 1] = nan, u[2 * 41] = std::numeric_limits<double>::infinity();
  std::vector<double> errors(contacts), smooth(contacts);
  set_squared_errors<Coulomb>(3, inverse_W_nn.data(), mu.data(), r.data(), u.data(), errors);
  set_squared_errors<Frictionless>(1, inverse_W_nn.data(), nullptr, r.data(), u.data(), smooth);
  for (std::size_t k = 0; k < contacts; ++k) {
    const double one = squared_error<Coulomb>(3 / inverse_W_nn[k], &mu[k], &r[2 * k], &u[2 * k]);
    const double one_smooth = squared_error<Frictionless>(1 / inverse_W_nn[k], nullptr, &r[k], &u[k]);
    EXPECT_EQ(std::isnan(errors[k]), k == 20 || k == 11 || k == 12) << k;
    EXPECT_EQ(std::isnan(smooth[k]), k == 22 || k == 25) << k;
    EXPECT_TRUE(errors[k] == one || (std::isnan(errors[k]) && std::isnan(one))) << k;
    EXPECT_TRUE(smooth[k] == one_smooth || (std::isnan(smooth[k]) && std::isnan(one_smooth))) << k;
  }
}

/// A chain of discs, in an order that strips of it can be swept in if it is `planned`.
CoulombSpinProblem chain(int discs, bool planned, std::vector<double>& r) {
  CoulombSpinProblem problem;
  problem.W.inverse_mass.assign(discs, 1.0);
  problem.W.inverse_mass.push_back(0);
  std::vector<std::int32_t> i, j, order;
  for (int k = 0; k < discs; ++k) i.push_back(k), j.push_back(k == 0 ? discs : k - 1), order.push_back(k);
  if (planned) problem.W.plan = sweep_plan(discs, i, j, order);
  for (const std::int32_t k : order) {
    problem.W.add(i[k], j[k], std::sin(k), std::cos(k));
    problem.q.insert(problem.q.end(), {-1e-3 * std::sin(7 * k), 1e-3 * std::cos(3 * k)});
    problem.mu.push_back(0.4);
    r.insert(r.end(), {std::abs(std::sin(5 * k)), 0.3 * std::sin(11 * k)});
  }
  return problem;
}

TEST(Residual, IsTheSameBytesForAnyTeam) {
  // Chains long enough that threads share them; where many contacts are planned, bodies too.
  for (const bool planned : {false, true}) {
    std::vector<double> r;
    const CoulombSpinProblem problem = chain(planned ? 60000 : 20000, planned, r);
    Velocities<CoulombSpinProblem::Delassus> velocities, alone_too;
    ParallelLoops no_team;
    const auto alone = residual_of(problem, std::span<const double>(r), alone_too, no_team);
    ThreadPool pool(3);
    ParallelLoops loops(&pool);
    const auto shared = residual_of(problem, std::span<const double>(r), velocities, loops);
    EXPECT_EQ(alone.rms, shared.rms);
    EXPECT_EQ(alone.max, shared.max);
    EXPECT_EQ(alone.penetration, shared.penetration);
    EXPECT_EQ(alone.sinking, shared.sinking);
    EXPECT_EQ(alone_too.contacts, velocities.contacts);
    EXPECT_GT(alone.rms, 0);
  }
}

TEST(Residual, OfManyContactsAddsUpTheSameVelocitiesInAnotherOrder) {
  std::vector<double> r;
  const CoulombSpinProblem problem = chain(60000, true, r);
  CoulombSpinProblem::Delassus::State in_turn, by_slices;
  CoulombSpinProblem unplanned = problem;
  unplanned.W.plan = {};
  unplanned.W.load(in_turn, r);
  problem.W.load(by_slices, r, ParallelLoops());
  ASSERT_EQ(by_slices.size(), in_turn.size());
  for (std::size_t b = 0; b + 1 < in_turn.size(); ++b) {
    EXPECT_NEAR(by_slices[b].x, in_turn[b].x, 1e-15);
    EXPECT_NEAR(by_slices[b].z, in_turn[b].z, 1e-15);
    EXPECT_NEAR(by_slices[b].s, in_turn[b].s, 1e-15);
    EXPECT_EQ(by_slices[b].inverse_mass, in_turn[b].inverse_mass);
  }
  EXPECT_EQ(by_slices.back().x, 0);
}

TEST(Residual, BlocksOfEqualEigenvaluesThatRoundingMadeUnsymmetric) {
  BlockDelassus W;
  W.diagonal.resize(1);
  W.diagonal[0] << 2, 1e-17, -1e-16, 2;
  EXPECT_NEAR(W.largest_eigenvalue(0), 2, 1e-15);
}

TEST(Residual, ExactSolutionsHaveNone) {
  // W = (1/m, 3/m) = (0.5, 1.5): r = (2, -0.2) stops q = (-1, 0.3), within mu = 0.5.
  const auto v = residual(disc_on_floor(-1, 0.3, 0.5), {2, -0.2});
  EXPECT_NEAR(v.rms, 0, 1e-15);
  EXPECT_NEAR(v.penetration, 0, 1e-15);
  // mu = 0.05: r_t = -0.1, u_t = 0.3 - 0.15 = 0.15 > 0 opposes r_t.
  EXPECT_NEAR(residual(disc_on_floor(-1, 0.3, 0.05), {2, -0.1}).rms, 0, 1e-15);
  EXPECT_EQ(residual(disc_on_floor(1, 0.3, 0.5), {0, 0}).rms, 0);  // opens
}

TEST(Residual, IsNotHiddenByAnInfiniteGap) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  CoulombSpinProblem problem = disc_on_floor(-1, 0, 0.5);
  problem.W.add(0, 1, 0, 1);
  problem.q = {-1, 0, infinite, 0};
  problem.mu = {0.5, 0.5};
  EXPECT_EQ(residual(problem, {0, 0, 0, 0}).rms, infinite);
  EXPECT_EQ(residual(problem, {0, 0, 0, 0}).max, infinite);
  EXPECT_EQ(residual(problem, {2, 0, 0, 0}).rms, 0);
  EXPECT_TRUE(std::isnan(residual(problem, {std::nan(""), 0, 0, 0}).rms));  // as callers tell it
}

TEST(Residual, MissingImpulseCountsItsVelocity) {
  // r = 0: e = |P_K(-rho (u_n + mu |u_t|), -rho u_t)| / rho with rho = 1/1.5. For u = (-1, 0): the projection
  // is (rho, 0), so e = 1. rms(q) = 1/sqrt(2).
  const auto v = residual(disc_on_floor(-1, 0, 0.5), {0, 0});
  EXPECT_NEAR(v.rms, std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(v.max, std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(v.penetration, 0.1, 1e-15);
}

TEST(Residual, SinkingAddsUpAlongAChain) {
  // Three discs of mass 1 on one another; each contact lets its disc sink by 0.1 against the one below. Their
  // impulses are 1 - 0.1 k, the contacts carry those above, and 0.1 (0.9 + 2 0.8 + 3 0.7) / 2.4 is the mean
  // velocity weighted with what is carried.
  FrictionlessProblem problem;
  problem.W.inverse_mass = {1, 1, 1, 0};
  problem.W.add(0, 3, 0, 1);
  problem.W.add(1, 0, 0, 1);
  problem.W.add(2, 1, 0, 1);
  problem.q = {-1, 0, 0};
  problem.time_step = 0.1;
  const std::vector<double> r = {2.4, 1.5, 0.7};
  const ContactResidual v = residual_of(problem, std::span<const double>(r));
  EXPECT_NEAR(v.penetration, 0.01, 1e-15);
  EXPECT_NEAR(v.sinking, 0.1 * 0.46 / 2.4, 1e-15);
  const std::vector<double> exact = {3, 2, 1};
  EXPECT_NEAR(residual_of(problem, std::span<const double>(exact)).sinking, 0, 1e-15);
}

TEST(Residual, OfSteepFrictionCountsATangentialVelocityOnce) {
  // Well inside of its cone, with a sliding velocity of 0.3 that friction should have stopped.
  for (const double mu : {1.5, 10.0, 100.0})
    EXPECT_NEAR(residual(disc_on_floor(-1, 0.3, mu), {2, 0}).rms, 0.3 / std::sqrt(1.09 / 2), 1e-14);
  // At the bound, r_n too small by 0.1: u_n = -0.1, and r_t by mu as much. W_nn = 1/2, W_tt = 3/2.
  const ContactResidual sliding = residual(disc_on_floor(-1, 100, 10), {1.8, -18});
  const double rise = 0.1 / 1.5;
  EXPECT_NEAR(sliding.rms, 1.5 * std::hypot(rise, 10 * rise) / std::sqrt((1 + 1e4) / 2), 1e-14);
}

TEST(Residual, SinkingCountsWallsThatContactsPush) {
  // A disc without weight between a floor and a wall of mass 1 that comes down at 1 and is let through by
  // 0.1: 0.9 * 0.1 over what the wall takes, 0.9.
  FrictionlessProblem problem;
  problem.W.inverse_mass = {1, 0, 0};
  problem.W.driven = {{0, 1, 1}};
  problem.W.add(0, 1, 0, 1);
  problem.W.add(0, 2, 0, -1);
  problem.q = {0, -1};
  problem.time_step = 0.1;
  const std::vector<double> r = {0.9, 0.9};
  EXPECT_NEAR(residual_of(problem, std::span<const double>(r)).sinking, 0.01, 1e-15);
}

TEST(Residual, SinkingCountsTheSidesOfACellUnderPressure) {
  // A disc that touches its own image across a cell of length 2, whose rate answers with 1/4 to an arm of 2:
  // W_nn = 1, and the side takes 0.9.
  FrictionlessProblem problem;
  problem.W.inverse_mass = {1, 0, 0};
  problem.W.cell = CellBody{0.25, 0, 2, 1};
  problem.W.resize_uninitialized(1);
  problem.W.arm_x[0] = 2, problem.W.arm_z[0] = 0;
  problem.W.set(0, 0, 0, 1, 0);
  problem.q = {-1};
  problem.time_step = 0.1;
  const std::vector<double> r = {0.9};
  EXPECT_NEAR(residual_of(problem, std::span<const double>(r)).sinking, 0.01, 1e-15);
}

TEST(Residual, TakesTheRmsOverContacts) {
  CoulombSpinProblem problem;
  problem.W.inverse_mass = {1, 1, 0};
  problem.W.add(0, 2, 0, 1);
  problem.W.add(1, 2, 0, 1);
  problem.q = {-1, 0, -1, 0};
  problem.mu = {0.5, 0.5};
  // The first contact is solved, the second is not: e = (0, 1), rms(q) = 1/sqrt(2).
  const std::vector<double> r{1, 0, 0, 0};
  const auto v = residual_of(problem, std::span<const double>(r));
  EXPECT_NEAR(v.rms, std::sqrt(0.5) * std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(v.max, std::sqrt(2.0), 1e-14);
}

TEST(Residual, DoesNotDependOnUnitsOfMassOrVelocity) {
  const auto plain = residual(disc_on_floor(-1, 0.3, 0.5), {1.7, -0.3});
  const auto heavy = residual(disc_on_floor(-1, 0.3, 0.5, 2000), {1700, -300});
  auto fast = disc_on_floor(-10, 3, 0.5);
  EXPECT_NEAR(plain.rms, heavy.rms, 1e-13);
  EXPECT_NEAR(plain.rms, residual(fast, {17, -3}).rms, 1e-13);
}

TEST(Residual, SeesNotANumber) {
  const double nan = std::nan("");
  EXPECT_TRUE(std::isnan(residual(disc_on_floor(-1, 0, 0.5), {nan, 0}).rms));
  EXPECT_TRUE(std::isnan(residual(disc_on_floor(nan, 0, 0.5), {1, 0}).rms));
}

TEST(Residual, RefersToRoundingWhereQIsSmaller) {
  // A disc between two walls, too wide for them by rounding: e = 1e-17 at each. What cancels carries nothing.
  FrictionlessProblem problem;
  problem.W.inverse_mass = {1, 0};
  problem.W.add(0, 1, 1, 0);
  problem.W.add(0, 1, -1, 0);
  problem.q = {-1e-17, -1e-17};
  const std::vector<double> r = {1e-17, 1e-17};
  EXPECT_EQ(residual_of(problem, std::span<const double>(r)).sinking,
            std::numeric_limits<double>::infinity());
  problem.rounding = 1e-13;
  const ContactResidual v = residual_of(problem, std::span<const double>(r));
  EXPECT_NEAR(v.rms, 1e-4, 1e-5);
  EXPECT_EQ(v.sinking, 0);
  problem.q = {-1, -1};
  EXPECT_EQ(residual_of(problem, std::span<const double>(r)).rms, 1);
}

TEST(Residual, EmptyProblemIsSolved) {
  CoulombSpinProblem problem;
  problem.W.inverse_mass = {1, 0};
  EXPECT_EQ(residual_of(problem, std::span<const double>()).rms, 0);
}

}  // namespace
}  // namespace drumlin
