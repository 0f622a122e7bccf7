#include "coupling/core/law/well_posedness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "continuum/rheology/turned_law.hpp"
#include "coupling/core/law/ill_posed.hpp"

namespace drumlin {
using namespace continuum;
namespace {

// Unit pressure: I = 2 |D|.
bool well_posed(const StressLaw& law, double I) {
  return well_posedness_margin(strength(law, 0.5 * I, 1), 0.5 * I) >= 0;
}

// Barker, Schaeffer, Bohorquez & Gray, J. Fluid Mech. 779 (2015), eq. (1.7) for two dimensions.
template <class Law>
bool barker(const Law& law, double I) {
  const FrictionValue f = law.friction(I);
  const double y = f.slope / f.mu, half = f.mu * (1 - 0.5 * y);
  return 4 * y * y - 4 * y + half * half <= 0;
}

TEST(WellPosedness, IsTheConditionOfBarkerEtAlForEveryInertialNumber) {
  const LogLaw paper{0.35, 0.013};
  const JopLaw jop{0.383, 0.643, 0.279};
  for (double log_I = -8; log_I < 2; log_I += 0.01) {
    const double I = std::pow(10, log_I);
    EXPECT_EQ(well_posed(paper, I), barker(paper, I)) << I;
    EXPECT_EQ(well_posed(jop, I), barker(jop, I)) << I;
  }
}

TEST(WellPosedness, HoldsForANewtonianFluid) {
  EXPECT_GT(well_posedness_margin(strength(NewtonianLaw{3}, 0.5, 1), 0.5), 0);
}

TEST(WellPosedness, RegularisedRigidPartsAreWellPosed) {
  // |D| far below eps: the law is a fluid of constant viscosity there, whatever its friction does.
  const LogLaw decimal{0.35, 0.013 / std::log(10.0)};
  EXPECT_GT(well_posedness_margin(strength(decimal, 0.5e-3, 1), 0.5e-3, 0.01), 0);
}

TEST(MinimumOnCircle, IsFoundWhateverTheForm) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 500; ++trial) {
    CircleForm form{normal(random), normal(random), normal(random),
                    normal(random), normal(random), normal(random)};
    if (trial % 4 == 0) form.x = form.y = 0;
    if (trial % 4 == 1) form.xy = form.x = 0;  // the linear part along an axis of the quadratic one
    if (trial % 4 == 2) form.xx = form.yy, form.xy = 0;
    double smallest = 1e300;
    for (int i = 0; i < 4000; ++i) {
      const double angle = 2 * std::numbers::pi * i / 4000, x = std::cos(angle), y = std::sin(angle);
      smallest = std::min(smallest, form.constant + form.x * x + form.y * y + form.xx * x * x +
                                        2 * form.xy * x * y + form.yy * y * y);
    }
    // Between the 4000 directions the form falls by at most its curvature, about 20, times (pi/4000)^2/2.
    EXPECT_LE(minimum_on_circle(form), smallest + 1e-12);
    EXPECT_GE(minimum_on_circle(form), smallest - 1e-5);
  }
}

double margin(const LogLaw& mu, const StressRatioLaw& k, double I_p, double turn = 1) {
  return well_posedness_margin(turned_strength(mu, LocalRatio{&k, turn}, 0.5 * I_p, 1), 0.5 * I_p);
}

/// The pressure p = 1 at which a flow of constant k has this I.
double rate_number(double I, double k) { return I / std::sqrt(0.5 * (1 + k)); }

TEST(WellPosednessWithK, IsTheConditionWithoutKForKOne) {
  const StressRatioLaw one({1}, {1});
  for (const LogLaw& law : {LogLaw{0.35, 0.013}, LogLaw{0.35, 0.0056}, LogLaw{0.4, 0.1}})
    for (double I = 1e-8; I < 30; I *= 1.2)
      EXPECT_NEAR(margin(law, one, I), well_posedness_margin(strength(law, 0.5 * I, 1), 0.5 * I), 1e-12) << I;
}

TEST(WellPosednessWithK, BoundsAConstantKFromBothSides) {
  const LogLaw paper{0.35, 0.013};
  const auto good = [&](double I, double k) {
    return margin(paper, StressRatioLaw({1}, {k}), rate_number(I, k)) >= 0;
  };
  // 0.89 to 1.12 and 0.95 to 1.06, to their last digit.
  EXPECT_TRUE(good(1e-4, 0.895) && good(1e-4, 1.115));
  EXPECT_FALSE(good(1e-4, 0.885) || good(1e-4, 1.125));
  EXPECT_TRUE(good(0.1, 0.955) && good(0.1, 1.055));
  EXPECT_FALSE(good(0.1, 0.945) || good(0.1, 1.065));
}

TEST(WellPosednessWithK, TheSenseOfTheShearDoesNotMatter) {
  const StressRatioLaw bump({1e-5, 1e-3, 1e-2}, {0.8, 1.2, 1.0});
  for (double I = 1e-6; I < 1; I *= 1.3)
    EXPECT_NEAR(margin({0.35, 0.013}, bump, I, 1), margin({0.35, 0.013}, bump, I, -1), 1e-12);
}

// Growth of a plane wave, from the response of the point itself by differences: independent of the algebra.
// `response` takes D, p and by how much spin over rate has changed.
template <class Response>
double numeric_symbol(const Response& response, double psi, const Regularisation& r, double size) {
  const double h = 1e-6, p = 1;
  const double angle =
      0.5 * (0.5 * std::numbers::pi - psi);  // D's (a, b) stands at 90 degrees in simple shear
  const double c = std::cos(angle), s = std::sin(angle);
  const PlaneTensor D{0, 0, size}, wave{-c * s, c * s, 0.5 * (c * c - s * s)};
  const double rate0 = regularised_rate(D, r);
  const auto stress = [&](double by_wave, double by_p) {
    const PlaneTensor now = D + by_wave * wave;
    // The spin of the wave is -1/2 of its strain.
    const double ratio = (size - 0.5 * by_wave) / regularised_rate(now, r) - size / rate0;
    return response(now, p + by_p, ratio).stress;
  };
  const auto slope = [&](double w, double q) {
    return (1 / (2 * h)) * (stress(h * w * size, h * q) - stress(-h * w * size, -h * q));
  };
  const PlaneTensor by_wave = (1 / size) * slope(1, 0), by_p = slope(0, 1);
  const auto normal = [&](const PlaneTensor& t) { return c * c * t.xx + 2 * c * s * t.xz + s * s * t.zz; };
  const auto shear = [&](const PlaneTensor& t) { return c * s * (t.zz - t.xx) + (c * c - s * s) * t.xz; };
  const double pressure = normal(by_wave) / (1 - normal(by_p));
  return (shear(by_wave) + shear(by_p) * pressure) / (0.5 * response(D, p, 0).modulus) * (1 - normal(by_p));
}
template <class Response>
double smallest_growth(const Response& response, const Regularisation& r, double size) {
  double smallest = 1e300;
  for (int i = 0; i < 2000; ++i)
    smallest = std::min(smallest, numeric_symbol(response, 2 * std::numbers::pi * i / 2000, r, size));
  return smallest;
}

// F = c + mu(I) p is ill-posed where 4 n^2 - 4 n + F_p^2 > 0, n = I mu' p/F: cohesion helps in slow flow and
// harms in fast flow.
TEST(WellPosedness, OfACohesiveLawIsTheSmallestGrowthOfAllWaves) {
  const double p = 1;
  for (const CohesiveLaw& law : {CohesiveLaw{0, 0.3, 1}, CohesiveLaw{0.1, 0.1, 0.5}, CohesiveLaw{2, 0.1, 3}})
    for (const double size : {1e-5, 3e-3, 0.05, 0.3}) {
      const Regularisation r{1e-12, 1e-9};
      const auto response = [&](const PlaneTensor& D, double pressure, double) {
        return stress_response(law, r, D, pressure, D);
      };
      const Strength F = strength(law, size, p);
      const double got = well_posedness_margin(F, size), n = 2 * size * law.b / F.value;
      EXPECT_NEAR(got, smallest_growth(response, r, size), 2e-5) << law.words() << " at " << size;
      EXPECT_EQ(got<0, 4 * n * n - 4 * n + F.d_pressure * F.d_pressure> 0) << law.words() << " at " << size;
    }
}

TEST(WellPosednessWithK, IsTheSmallestGrowthOfAllWaves) {
  const StressRatioLaw bump({1e-5, 1e-3, 1e-2}, {0.8, 1.2, 1.0});
  const LogLaw paper{0.35, 0.013};
  for (const double size : {1e-5, 3e-4, 2e-3, 0.03})
    for (const double eps : {1e-12, 1e-3})
      for (const double follow : {0.0, 0.3}) {
        const Regularisation r{eps, 1e-9};
        // The turn follows by `follow` per unit of spin over rate.
        const auto response = [&](const PlaneTensor& D, double p, double ratio) {
          return turned_response(paper, LocalRatio{&bump, 1 + follow * ratio}, r, D, p, D);
        };
        const PlaneTensor D{0, 0, size};
        const auto s = turned_response(paper, LocalRatio{&bump, 1}, r, D, 1, D);
        const double m = magnitude(s.right), beta = (s.at.k - 1) / (s.at.k + 1);
        const double got = well_posedness_margin(TurnedStrength{s.strength, s.across, s.at}, s.rate, m,
                                                 {.spin_ratio = size / s.rate, .slope = beta * follow});
        EXPECT_NEAR(got, smallest_growth(response, r, size), 2e-5) << size << " " << eps << " " << follow;
      }
}

TEST(IllPosedRanges, AreThoseOfThePublishedLaws) {
  EXPECT_TRUE(ill_posed_intervals(LogLaw{0.35, 0.013}, nullptr, 1e-7, 3).empty());
  const auto decimal = ill_posed_intervals(LogLaw{0.35, 0.013 / std::log(10.0)}, nullptr);
  ASSERT_EQ(decimal.size(), 1u);
  // By hand: 4 y = mu^2 for small y = b/mu, hence mu^3 = 4 b = 0.0226, mu = 0.2827, I = 6.6e-6.
  EXPECT_NEAR(decimal[0].from, 6.6e-6, 0.1e-6);
  EXPECT_EQ(decimal[0].to, 1);
  const auto jop = ill_posed_intervals(JopLaw{0.383, 0.643, 0.279}, nullptr);
  ASSERT_EQ(jop.size(), 2u);
  EXPECT_EQ(jop[0].from, 1e-6);
  EXPECT_NEAR(jop[0].to, 0.020, 0.001);
  EXPECT_NEAR(jop[1].from, 0.85, 0.01);
  const auto constant = ill_posed_intervals(ConstantLaw{0.3}, nullptr);
  ASSERT_EQ(constant.size(), 1u);
  EXPECT_EQ(constant[0].from, 1e-6);
  EXPECT_EQ(constant[0].to, 1);
}

TEST(IllPosedRanges, OfThePapersBumpReachToTheFallOfK) {
  const StressRatioLaw bump({1e-5, 1e-3, 1e-2}, {0.8, 1.2, 1.0});
  const auto ranges = ill_posed_intervals(LogLaw{0.35, 0.013}, &bump);
  ASSERT_FALSE(ranges.empty());
  EXPECT_EQ(ranges.front().from, 1e-6);
  EXPECT_GT(ranges.front().to, 1e-3);
  EXPECT_LT(ranges.back().to, 0.01);
  for (const InertialRange& range : ranges) EXPECT_LT(range.from, range.to);
}

}  // namespace
}  // namespace drumlin
