#include "coupling/core/law/friction_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "continuum/rheology/stress_law.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/law/memory_law.hpp"

namespace drumlin {
using namespace continuum;
namespace {

const std::vector<double> I_of_table{1e-4, 1e-3, 3e-3, 1e-2, 0.1};

TEST(MonotoneCubic, PassesThroughItsPointsAndAddsNoExtremum) {
  const std::vector<double> x{0, 1, 1.5, 4, 5, 6}, y{0, 1, 1.1, 1.1, 3, 2.5};
  for (const auto outside : {MonotoneCubic::Outside::level, MonotoneCubic::Outside::goes_on}) {
    const MonotoneCubic curve(x, y, outside);
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(curve.at(x[i]).value, y[i], 1e-14);
    for (std::size_t i = 0; i + 1 < x.size(); ++i)
      for (double t = 0.01; t < 1; t += 0.01) {
        const double slope = curve.at(x[i] + t * (x[i + 1] - x[i])).slope;
        EXPECT_GE(slope * (y[i + 1] - y[i]), -1e-14) << x[i] << " + " << t;
      }
  }
}

TEST(MonotoneCubic, SlopeIsItsDerivativeAndHasNoJumps) {
  const MonotoneCubic curve({0, 1, 1.5, 4}, {0, 1, 1.2, 0.7}, MonotoneCubic::Outside::level);
  const double h = 1e-6;
  for (double x = -0.5; x < 5; x += 0.0371) {
    EXPECT_NEAR(curve.at(x).slope, (curve.at(x + h).value - curve.at(x - h).value) / (2 * h), 1e-5) << x;
    EXPECT_NEAR(curve.at(x + h).slope, curve.at(x - h).slope, 1e-4) << x;
  }
  for (const double knot : {0.0, 1.0, 1.5, 4.0})
    EXPECT_NEAR(curve.at(knot + 1e-9).slope, curve.at(knot - 1e-9).slope, 1e-7) << knot;
}

TEST(MonotoneCubic, OnePointIsAConstant) {
  const MonotoneCubic curve({2}, {1.1}, MonotoneCubic::Outside::level);
  for (const double x : {-3.0, 2.0, 9.0}) {
    EXPECT_EQ(curve.at(x).value, 1.1);
    EXPECT_EQ(curve.at(x).slope, 0);
  }
}

TEST(TabulatedLaw, GoesOnStraightInIWithoutAKink) {
  const TabulatedLaw table({1e-3, 1e-2, 2e-2, 4e-2}, {0.25, 0.26, 0.275, 0.305},
                           TabulatedLaw::Beyond::straight_in_I);
  EXPECT_NEAR(table.friction(0.1).mu, 0.305 + 1.5 * 0.06, 1e-5);  // as far as it is kept positive
  EXPECT_NEAR(table.friction(0.1).slope, 1.5 * 0.1, 1e-5);
  const double h = 1e-7;
  for (const double I : {0.005, 0.015, 0.03, 0.0399, 0.0401, 0.2})
    EXPECT_NEAR(table.friction(I).slope, I * (table.friction(I + h).mu - table.friction(I - h).mu) / (2 * h),
                1e-6)
        << I;
  EXPECT_NEAR(table.friction(0.04 * (1 - 1e-9)).slope, table.friction(0.04 * (1 + 1e-9)).slope, 1e-7);
  // Far apart the cubic before it would not grow everywhere.
  const TabulatedLaw wide({1e-5, 1e-3}, {0.2, 0.3}, TabulatedLaw::Beyond::straight_in_I);
  for (double I = 1e-5; I < 1; I *= 1.3) EXPECT_GE(wide.friction(I).slope, 0) << I;
}

TEST(TabulatedLaw, OfPointsOnALogarithmIsThatLogarithmInsideAndOutside) {
  const LogLaw log{0.35, 0.013};
  std::vector<double> mu;
  for (const double I : I_of_table) mu.push_back(log.a + log.b * std::log(I));
  const TabulatedLaw table(I_of_table, mu);
  for (double I = 1e-14; I < 1e3; I *= 1.7) {
    EXPECT_NEAR(table.friction(I).mu, log.friction(I).mu, 1e-13) << I;
    EXPECT_NEAR(table.friction(I).slope, log.friction(I).slope, 1e-13) << I;
  }
}

TEST(TabulatedLaw, GrowsEverywhereAndStaysPositive) {
  const TabulatedLaw table(I_of_table, {0.1, 0.2, 0.21, 0.3, 0.32});
  double last = 0;
  for (double I = 1e-20; I < 1e6; I *= 1.1) {
    const FrictionValue at = table.friction(I);
    EXPECT_GT(at.mu, last) << I;
    EXPECT_GT(at.slope, 0) << I;
    last = at.mu;
  }
}

TEST(StressLawOfAFile, HasTheFormThatTheFileNames) {
  RheologyFit fit;
  fit.mu = LogLaw{.a = 0.35, .b = 0.013};
  EXPECT_EQ(std::get<LogLaw>(stress_law(fit)).b, 0.013);
  fit.mu = ConstantLaw{0.3};
  EXPECT_EQ(std::get<ConstantLaw>(stress_law(fit)).mu, 0.3);
  fit.mu = JopLaw{0.383, 0.643, 0.279};
  EXPECT_EQ(std::get<JopLaw>(stress_law(fit)).I_0, 0.279);
  fit.mu = FrictionTable{{1e-3, 1e-1}, {0.2, 0.3}};
  EXPECT_NEAR(std::get<TabulatedLaw>(stress_law(fit)).friction(0.01).mu, 0.25, 1e-5);
}

TEST(MemoryLaw, TurnsNewMemoryByChiInSlowShearAndAsSimpleShearAsksInFastShear) {
  const MemoryLaw law{.c = 6, .m = 1, .chi_deg = 30, .c_rho = 100, .mu = {{1e-5, 1e-3}, {0.2, 0.25}}};
  const double slow = 30 * std::numbers::pi / 180, fast = std::atan(1.0 / 6);
  EXPECT_EQ(memory_turn(law, 1e-7), slow);
  EXPECT_EQ(memory_turn(law, 1e-3), slow);
  EXPECT_NEAR(memory_turn(law, std::sqrt(1e-5)), 0.5 * (slow + fast), 1e-12);
  EXPECT_NEAR(memory_turn(law, 1e-2), fast, 1e-15);
  EXPECT_NEAR(memory_turn(law, 1), fast, 1e-15);
  for (const double I : {1e-3, 1e-2})  // no kink where it sets in and where it ends
    EXPECT_NEAR((memory_turn(law, I * 1.001) - memory_turn(law, I / 1.001)) / 0.002, 0, 1e-3);
  EXPECT_NEAR(memory_friction(law).friction(1e-4).mu, 0.225, 1e-5);
}

TEST(SampledFriction, IsTheFunctionAsAFlowEvaluatesIt) {
  const auto mu = [](double I) { return 0.36 + 0.5 * std::pow(I, 0.7); };
  const FrictionTable table = sampled_friction(mu, 1e-4, 1, 16);
  EXPECT_EQ(table.I.size(), 65u);
  const FrictionLaw law = table;
  for (double I = 1.3e-4; I < 1; I *= 1.7) {
    EXPECT_NEAR(friction_at(law, I).mu, mu(I), 1e-4) << I;
    EXPECT_NEAR(friction_at(law, I).slope, 0.35 * std::pow(I, 0.7), 5e-3) << I;
  }
}

TEST(SampledFriction, RefusesWhatIsNoFriction) {
  const auto refused = [](auto mu, double from, double to, int per_decade = 8) {
    EXPECT_THROW((void)sampled_friction(mu, from, to, per_decade), InputError);
  };
  const auto level = [](double) { return 0.3; };
  refused(level, 1e-3, 1e-1);
  refused([](double I) { return I - 0.01; }, 1e-3, 1e-1);
  refused([](double I) { return std::sqrt(0.05 - I); }, 1e-3, 1e-1);
  const auto grows = [](double I) { return 0.3 + I; };
  refused(grows, 0, 1), refused(grows, 1, 0.1), refused(grows, 1e-3, 1, 0);
}

}  // namespace
}  // namespace drumlin
