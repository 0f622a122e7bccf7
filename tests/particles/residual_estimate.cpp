// What solvers in strips estimate of their residual on the way is the residual.
#include "particles/solver/residual_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "particles/contact/problems.hpp"
#include "particles/contact/residual.hpp"
#include "particles/solver/solve_end.hpp"
#include "particles/solver/strip_solver.hpp"
#include "tests/particles/solving.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// A column of discs on a floor whose impulses solve nothing.
struct Column {
  CoulombSpinProblem problem;
  std::vector<double> r;
};

Column column(int discs, double mu = 0.4) {
  Column column;
  auto& [problem, r] = column;
  problem.W.inverse_mass.assign(discs + 1, 0.5);
  problem.W.inverse_mass.back() = 0;
  problem.time_step = 0.05;
  for (int b = 0; b < discs; ++b) {
    problem.W.add(b, b == 0 ? discs : b - 1, 0, 1);
    problem.q.push_back(b == 0 ? -0.05 : 0.01 * (b % 3)), problem.q.push_back(0.02 * (b % 5 - 2));
    problem.mu.push_back(mu);
    r.push_back(0.1 + 0.05 * (b % 4)), r.push_back(0.02 * (b % 3 - 1));
  }
  return column;
}

template <class T>
void expect_estimate(double precision, double mu = 0.4) {
  const auto [problem, r] = column(200, mu);
  std::vector<std::int32_t> order;
  const SweepPlan plan = sweep_plan(problem.W.fixed(), problem.W.i, problem.W.j, order);
  ParallelLoops loops;
  StripProblem<T, Coulomb, true> strips;
  strips.pack(problem, plan, order, r, loops);
  for (const int phase : {0, 1})
    for (int strip = 0; strip < strips.strips(); ++strip) strips.load(strip, phase);
  for (const int phase : {0, 1})
    for (int strip = 0; strip < strips.strips(); ++strip) strips.estimate_residual(strip, phase);
  const ResidualEstimate estimate = strips.residual_estimate();
  const double impulses = strips.summed_impulses(loops), h = problem.time_step;
  const ContactResidual exact = residual_at(problem, r);
  const double q_squares = squared_norm(problem.q);
  EXPECT_NEAR(std::sqrt(estimate.squares * 2 / q_squares) / exact.rms, 1, precision);
  EXPECT_GT(exact.penetration, 0);
  EXPECT_NEAR(-estimate.lowest_u_n * h / exact.penetration, 1, precision);
  EXPECT_GT(exact.sinking, 0);
  EXPECT_NEAR(h * estimate.complementarity_violation / impulses / exact.sinking, 1, precision);
  // A limit is surely missed from two hundredths beyond it on, in sweeps that extrapolate exactly from less.
  const double relative = std::sqrt(estimate.squares * 2 / q_squares);
  const auto surely_missed = [&](SweepExtrapolation how, double penetration, double sinking) {
    StoppingRule rule;
    rule.tolerance = 2 * exact.rms, rule.penetration = penetration, rule.sinking = sinking;
    LimitRatios ratios = limit_ratios(estimate, relative, h, rule);
    ratios.sinking = sinking_of(estimate, impulses, h, rule);
    return SolveProgress(how).surely_missed(ratios);
  };
  const auto none = std::numeric_limits<double>::infinity();
  for (const auto how : {SweepExtrapolation::rounded, SweepExtrapolation::exact}) {
    const bool exactly = how == SweepExtrapolation::exact;
    EXPECT_FALSE(surely_missed(how, none, none));
    EXPECT_EQ(surely_missed(how, exact.penetration / 1.01, none), exactly);
    EXPECT_EQ(surely_missed(how, none, exact.sinking / 1.01), exactly);
    EXPECT_TRUE(surely_missed(how, exact.penetration / 1.03, none));
    EXPECT_TRUE(surely_missed(how, none, exact.sinking / 1.03));
  }
}

/// Residuals that are small enough and bodies that sink too fast, by less and less.
TEST(SolveProgress, SlowlyOfWhatIsMissedCountsWhereSweepsExtrapolateExactly) {
  SolveProgress rounded(SweepExtrapolation::rounded), exact(SweepExtrapolation::exact);
  for (int sweeps = 10; sweeps <= 400; sweeps += 10)
    for (SolveProgress* progress : {&rounded, &exact}) {
      const LimitRatios ratios{0.6, 0.5, 1.2 - 1e-4 * sweeps};
      progress->record(ratios, sweeps);
      EXPECT_EQ(progress->idle(sweeps) >= 200, progress == &rounded && sweeps >= 210) << sweeps;
    }
  for (int sweeps = 410; sweeps < 600; sweeps += 10) exact.record({0.6, 0.5, 1.16}, sweeps);
  EXPECT_EQ(exact.idle(600), 230);
  // The estimate is a little less than the residual.
  const LimitRatios ratios{0.6, 0.5, 0.999};
  for (SolveProgress* progress : {&rounded, &exact}) {
    EXPECT_FALSE(progress->surely_missed(ratios));
    progress->compare(ratios, 1.005);
    EXPECT_EQ(progress->surely_missed(ratios), progress == &exact);
    EXPECT_FALSE(progress->surely_missed({0.6, 0.5, 0.993}));
  }
}

TEST(ResidualEstimate, IsTheResidualInDoublePrecision) { expect_estimate<double>(1e-12); }
TEST(ResidualEstimate, IsNearlyTheResidualInSinglePrecision) { expect_estimate<float>(1e-4); }
TEST(ResidualEstimate, OfSteepFrictionIsTheResidual) {
  expect_estimate<double>(1e-12, 30);
  expect_estimate<float>(1e-4, 30);
}

/// How far, in parts of it, single precision sees another residual than impulses have after sweeps with
/// momentum, under a load of thousand discs.
double error_of_the_estimate(SweepExtrapolation how) {
  constexpr int discs = 1000, sweeps = 100;
  const auto [problem, unused] = column(discs);
  std::vector<double> r;  // each disc carries those above it, and swings
  for (int b = 0; b < discs; ++b)
    r.push_back(0.1 * (discs - b) + 0.05 * (b % 4)), r.push_back(0.01 * (b % 3 - 1));
  std::vector<std::int32_t> order;
  const SweepPlan plan = sweep_plan(problem.W.fixed(), problem.W.i, problem.W.j, order);
  ParallelLoops loops;
  StripProblem<float, Coulomb, true> strips;
  strips.pack(problem, plan, order, r, loops);
  const auto each = [&](auto work) {
    for (const int phase : {0, 1})
      for (int strip = 0; strip < strips.strips(); ++strip) work(strip, phase);
  };
  each([&](int strip, int phase) { strips.load(strip, phase); });
  for (int strip = 0; strip < strips.strips(); ++strip) strips.start(strip);
  for (int k = 0; k < sweeps; ++k)
    each([&](int strip, int phase) { strips.sweep(strip, phase, 0, k == 0 ? 0.0F : 0.95F, how); });
  each([&](int strip, int phase) { strips.estimate_residual(strip, phase); });
  strips.unpack(problem, false, r, loops);
  const double estimate = std::sqrt(strips.residual_estimate().squares * 2 / squared_norm(problem.q));
  return std::abs(estimate / residual_at(problem, r).rms - 1);
}

TEST(ResidualEstimate, StaysTrueUnderMomentumWhereBodiesReceiveWhatImpulsesRoundOff) {
  const double rounded = error_of_the_estimate(SweepExtrapolation::rounded);
  const double exact = error_of_the_estimate(SweepExtrapolation::exact);
  EXPECT_LT(exact, 1e-3);
  EXPECT_GT(rounded, 10 * exact) << exact;
}

/// Residuals that fall for 300 sweeps and then stand still, in single precision.
TEST(SolveEnd, EndsWhereEstimatesStandStill) {
  StoppingRule rule;
  rule.tolerance = 1e-9;
  rule.max_sweeps = 10000;
  SolveEnd::Kind kind;
  kind.single = true;
  double squares = 1;
  const SweptBlocks blocks{[&] {
                             return ResidualEstimate{squares, 0, 0};
                           },
                           [] { return 1.0; }, [] {},
                           [&](bool) {
                             ContactResidual residual;
                             residual.rms = std::sqrt(squares);
                             return residual;
                           }};
  SolveEnd end(rule, kind);
  int sweeps = 10;
  for (; sweeps < rule.max_sweeps && !end.ends(blocks, sweeps, 1, true, false); sweeps += 10)
    if (sweeps < 300) squares /= 2;
  EXPECT_EQ(sweeps, 500);
  EXPECT_EQ(end.report().status, Status::out_of_sweeps);
}

TEST(ResidualEstimate, OfAContactThatOpensWithoutFrictionIsNothing) {
  auto [problem, r] = column(200);
  std::fill(r.begin(), r.end(), 0.0);
  std::fill(problem.mu.begin(), problem.mu.end(), 0.0);
  for (int a = 0; a < problem.contacts(); ++a) problem.q[2 * a] = 0.1, problem.q[2 * a + 1] = 0;
  std::vector<std::int32_t> order;
  const SweepPlan plan = sweep_plan(problem.W.fixed(), problem.W.i, problem.W.j, order);
  StripProblem<float, Coulomb, true> strips;
  strips.pack(problem, plan, order, r, ParallelLoops());
  for (const int phase : {0, 1})
    for (int strip = 0; strip < strips.strips(); ++strip) strips.estimate_residual(strip, phase);
  EXPECT_EQ(strips.residual_estimate().squares, 0);
}

}  // namespace
}  // namespace drumlin
