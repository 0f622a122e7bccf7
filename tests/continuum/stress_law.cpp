#include "continuum/rheology/stress_law.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "continuum/rheology/nonlocal_law.hpp"
#include "continuum/rheology/tensor_law.hpp"
#include "continuum/rheology/threshold_fluidity.hpp"

namespace drumlin {
using namespace continuum;
namespace {

const LogLaw paper{0.35, 0.013};

TEST(LogLaw, GivesThePapersFriction) {
  // 0.35 + 0.013 ln 0.01 = 0.29013; the floor that keeps mu positive moves it by 3e-6.
  EXPECT_NEAR(paper.friction(0.01).mu, 0.2901, 5e-5);
}

TEST(LogLaw, StaysPositiveHoweverSlowTheShear) {
  for (double I = 1; I > 1e-60; I *= 0.1) EXPECT_GT(paper.friction(I).mu, 0) << I;
}

TEST(JopLaw, RunsBetweenItsTwoFrictions) {
  const JopLaw jop{0.383, 0.643, 0.279};
  EXPECT_NEAR(jop.friction(1e-9).mu, 0.383, 1e-8);
  EXPECT_NEAR(jop.friction(0.279).mu, 0.5 * (0.383 + 0.643), 1e-12);
  EXPECT_NEAR(jop.friction(1e9).mu, 0.643, 1e-8);
}

TEST(NonlocalLaw, IsTheLocalLawAtAnotherInertialNumber) {
  const double rate = 0.02, p = 4, factor = 0.1, h = 1e-6;
  const NonlocalLaw<LogLaw> law{paper, factor};
  const auto at = [&](double r, double pressure) { return strength(law, r, pressure); };
  EXPECT_NEAR(at(rate, p).value, paper.friction(factor * 2 * rate / std::sqrt(p)).mu * p, 1e-14);
  EXPECT_NEAR(at(rate, p).d_rate,
              (at(rate * (1 + h), p).value - at(rate * (1 - h), p).value) / (2 * h * rate), 1e-6);
  EXPECT_NEAR(at(rate, p).d_pressure,
              (at(rate, p * (1 + h)).value - at(rate, p * (1 - h)).value) / (2 * h * p), 1e-6);
  EXPECT_TRUE(tells_fluidity(paper));
  EXPECT_FALSE(tells_fluidity(ConstantLaw{0.3}));
  EXPECT_FALSE(tells_fluidity(JopLaw{0.383, 0.643, 0.279}));
}

TEST(StressLaw, SlopesAreThoseOfItsValues) {
  for (const StressLaw& law :
       {StressLaw(paper), StressLaw(JopLaw{0.383, 0.643, 0.279}), StressLaw(ConstantLaw{0.3}),
        StressLaw(TabulatedLaw({1e-4, 3e-3, 0.1}, {0.2, 0.29, 0.32})), StressLaw(CohesiveLaw{2, 0.3, 1.1}),
        StressLaw(NewtonianLaw{2})})
    for (const double rate : {1e-6, 1e-2, 3.0})
      for (const double p : {0.1, 7.0}) {
        const double h = 1e-6;  // relative; central differences err by h^2, rounding by 1e-16/h
        const Strength F = strength(law, rate, p);
        const double by_rate =
            (strength(law, rate * (1 + h), p).value - strength(law, rate * (1 - h), p).value) /
            (2 * rate * h);
        const double by_p =
            (strength(law, rate, p * (1 + h)).value - strength(law, rate, p * (1 - h)).value) / (2 * p * h);
        EXPECT_NEAR(F.d_rate, by_rate, 1e-7 * F.value / rate);
        EXPECT_NEAR(F.d_pressure, by_p, 1e-7 * F.value / p);
      }
}

TEST(TensorLaw, SimpleShearCarriesMuTimesThePressure) {
  const Regularisation none{1e-12, 1e-9};
  const double shear_rate = 0.02, p = 4;  // I = 0.01
  const PlaneTensor D{0, 0, shear_rate / 2};
  const auto s = stress_response(paper, none, D, p, D);
  EXPECT_NEAR(s.stress.xz, paper.friction(0.01).mu * p, 1e-9);
  EXPECT_EQ(s.stress.xx, 0);  // sigma_xx = sigma_zz = p: k is absent
  EXPECT_EQ(s.stress.zz, 0);
}

TEST(TensorLaw, TangentIsTheDerivativeOfTheStress) {
  const Regularisation smooth{0.05, 0.3};
  const PlaneTensor D{0.03, -0.03, 0.11}, dD{0.5, -0.2, 0.7};
  const double h = 1e-6;
  for (const double p : {-0.5, 0.2, 5.0}) {
    const auto dual = (1 / regularised_rate(D, smooth)) * D;
    const auto at = [&](double s, double t) {
      return stress_response(paper, smooth, D + s * dD, p + t, dual).stress;
    };
    const auto s = stress_response(paper, smooth, D, p, dual);
    const PlaneTensor by_D = (1 / (2 * h)) * (at(h, 0) - at(-h, 0)),
                      by_p = (1 / (2 * h)) * (at(0, h) - at(0, -h));
    EXPECT_LT(magnitude(tangent(s, dD) - by_D), 1e-7 * magnitude(by_D)) << p;
    EXPECT_LT(magnitude(s.by_pressure - by_p), 1e-7 * magnitude(by_p)) << p;
  }
}

TEST(TensorLaw, DissipatesHoweverTheMaterialMoves) {
  const Regularisation r{1e-3, 0.1};
  for (int i = 0; i < 200; ++i) {
    const PlaneTensor D{std::sin(1.0 * i), std::cos(2.0 * i), std::sin(3.0 * i + 1)};
    EXPECT_GT(contraction(stress_response(paper, r, D, i - 20.0, D).stress, D), 0);
  }
}

TEST(DualVariable, NeverLeavesTheUnitBall) {
  const PlaneTensor D{0.01, -0.01, 0.02}, dual{0.3, -0.3, 0.9};
  for (const double length : {0.1, 1.0, 100.0}) {
    const PlaneTensor next =
        advanced_dual(D, {-length, length, 2 * length}, dual, regularised_rate(D, {1e-2, 0.1}));
    EXPECT_LE(magnitude(next), 1 + 1e-14);
  }
}

TEST(ThresholdFluidityLaw, IsTheLawWhereNothingSpreadsAndNeverFallsBelowItsThreshold) {
  const TabulatedLaw falls({1e-5, 1e-3, 1e-1}, {0.16, 0.25, 0.36});
  for (const double I : {1e-6, 1e-4, 1e-2, 1e-1}) {
    const double p = 3, rate = 0.5 * I * std::sqrt(p), y = std::log(2 * rate / 0.3);
    const FluidityBalance at = fluidity_balance(falls, 0.26, y, rate, p);
    EXPECT_NEAR(at.mu, 0.3, 1e-14);
    EXPECT_GT(at.mu_loc, 0.26);
    EXPECT_NEAR(at.mu_loc, std::max(0.26, falls.friction(I).mu), 2e-4) << I;  // half a thousandth at the kink
    EXPECT_DOUBLE_EQ(fluidity_balance(falls, {}, y, rate, p).mu_loc, falls.friction(I).mu);
    EXPECT_NEAR(strength(FluidityLaw{y}, rate, p).value, 0.3 * p, 1e-14);
  }
}

TEST(ThresholdFluidityLaw, HasTheSlopesOfItsBalance) {
  const TabulatedLaw falls({1e-5, 1e-3, 1e-1}, {0.16, 0.25, 0.36});
  const double p = 3, y = -4, h = 1e-6;
  for (const double rate : {1e-5, 1e-3, 1e-2}) {
    const auto value = [&](double here, double pressure, double at_y) {
      const FluidityBalance at = fluidity_balance(falls, 0.26, at_y, here, pressure);
      return at.mu_loc - at.mu;
    };
    const FluidityBalance at = fluidity_balance(falls, 0.26, y, rate, p);
    EXPECT_NEAR((value(rate * (1 + h), p, y) - value(rate * (1 - h), p, y)) / (2 * h), rate * at.by_rate,
                1e-8);
    EXPECT_NEAR((value(rate, p + h, y) - value(rate, p - h, y)) / (2 * h), at.by_pressure, 1e-8);
    EXPECT_NEAR((value(rate, p, y + h) - value(rate, p, y - h)) / (2 * h), at.mu, 1e-8);
  }
}

}  // namespace
}  // namespace drumlin
