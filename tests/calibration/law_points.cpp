#include "coupling/calibration/law_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coupling/calibration/law_score.hpp"
#include "coupling/calibration/one_law.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/statistics/quantiles.hpp"
#include "shear_layer.hpp"

namespace drumlin {
using namespace coupling;
namespace {

using namespace testing;

TEST(LawPoints, ReadTheLawInAnyAxes) {
  for (const double angle : {0.0, 0.3, -0.7}) {
    const auto points = law_points(layer(angle, 0, 0), anywhere);
    ASSERT_GT(points.size(), 100u);
    for (const LawBlock& point : points) {
      EXPECT_NEAR(point.friction.mu, friction(logarithm, truth, point.friction.I), 1e-12);
      EXPECT_NEAR(point.turn, turn, 1e-12);
    }
  }
}

TEST(LawPoints, ErrorsAreIntervalsOverTheFactorThatTheMapTells) {
  FieldMap map = layer(0, 0.1, 0.1);
  const auto normal = law_points(map, anywhere);
  map.header.interval_factor =
      2 * statistics::normal_quantile_99;  // few batches: wide intervals, the same errors
  const auto wide = law_points(map, anywhere);
  ASSERT_EQ(wide.size(), normal.size());
  // Of the errors' own size, to which the noise of the gradient that is taken off its length adds a little.
  for (std::size_t i = 0; i < wide.size(); ++i)
    EXPECT_NEAR(wide[i].friction.mu_error / normal[i].friction.mu_error, 0.5, 0.05);
}

TEST(LawPoints, NoiseOfTheGradientIsTakenOffItsLength) {
  // Without it |D| is 4 % too long in a block of ten nodes, and mu as much too small.
  double mu = 0, I = 0, count = 0;
  for (const LawBlock& point : law_points(layer(0, 0, 0.6), anywhere)) {
    const double clean = 0.1 * std::exp(point.z / 7);
    mu += point.friction.mu / friction(logarithm, truth, clean);
    I += point.friction.I / clean;
    ++count;
  }
  EXPECT_NEAR(mu / count, 1, 0.03);  // dividing by a noisy length leaves its square
  EXPECT_NEAR(I / count, 1, 0.02);
}

TEST(LawPoints, ALawWithKIsThatOfSimpleShear) {
  const auto points = law_points(layer(0, 0, 0), anywhere);
  const double k = (1 + turn) / (1 - turn);
  const auto with_k = frictions_with_k(points, StressRatioLaw({1e-4, 1e-1}, {k, k}));
  for (std::size_t i = 0; i < points.size(); ++i) {
    // sigma_zz = 2p/(1 + k), sigma_xz = M p, I = 2|D|/sqrt(sigma_zz).
    EXPECT_NEAR(with_k[i].mu, points[i].friction.mu * (1 + k) / 2, 1e-12);
    EXPECT_NEAR(with_k[i].I, points[i].friction.I * std::sqrt((1 + k) / 2), 1e-12);
  }
}

TEST(LawPoints, AKnownLawComesBackWithinItsBand) {
  int inside = 0, compared = 0;
  for (unsigned seed = 0; seed < 10; ++seed) {
    const CalibratedLaw law =
        calibrated({frictions(law_points(layer(0.2, 0.1, 0.1, seed), anywhere))}, logarithm, 100);
    for (const double I : {5e-4, 5e-3, 5e-2}) {
      const FrictionBand band = law.band().at(I);
      inside += band.low <= friction(logarithm, truth, I) && friction(logarithm, truth, I) <= band.high;
      ++compared;
    }
  }
  EXPECT_GE(inside, compared - 3) << compared;
}

TEST(LawPoints, AMapWithoutWhatTheLawNeedsIsRefused) {
  FieldMap map = layer(0, 0, 0);
  map.fields.erase(map.fields.begin() + 3);
  EXPECT_THROW(law_points(map, anywhere), InputError);
  map = layer(0, 0, 0);
  map.header.axis_depth.reset();
  EXPECT_THROW(law_points(map, anywhere), InputError);
}

TEST(OneLaw, HoldsForSpeedsOfOneLawAndNotForTwo) {
  const auto with = [](double a, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0, 0.004);
    std::vector<FrictionPoint> points;
    for (int i = 0; i < 80; ++i) {
      const double I = 1e-4 * std::pow(1e3, (i + 0.5) / 80);
      points.push_back({I, a + 0.014 * std::log(I) + normal(random), 0, 0.004});
    }
    return std::vector<std::vector<FrictionPoint>>{points};
  };
  const auto verdict = [&](double a) {
    const auto slow = with(0.36, 1), fast = with(a, 2);
    const CalibratedLaw common = calibrated({slow[0], fast[0]}, logarithm, 100);
    return one_law_of({{"slow", slow}, {"fast", fast}}, common, 100);
  };
  EXPECT_TRUE(verdict(0.36).holds);
  const OneLaw two = verdict(0.40);
  EXPECT_FALSE(two.holds);
  EXPECT_GT(two.rms_common, 2 * two.rms_own);
}

TEST(LawScore, SaysHowFarAHeldOutRunLies) {
  std::vector<FrictionPoint> points;
  for (int i = 0; i < 40; ++i) {
    const double I = 1e-4 * std::pow(1e3, (i + 0.5) / 40);
    points.push_back({I, friction(logarithm, truth, I) + (i % 2 == 0 ? 0.005 : -0.005), 0, 0.005});
  }
  const CalibratedLaw law = calibrated({points}, logarithm, 100);
  for (FrictionPoint& point : points) point.mu += 0.05;
  points.push_back({0.5, 0.4, 0, 0.005});
  const LawScore score = score_of("other", points, law);
  EXPECT_NEAR(score.bias, 0.05, 1e-3);
  EXPECT_EQ(score.outside_range, 1u);
  EXPECT_EQ(score.inside_prediction, 0);
}

}  // namespace
}  // namespace drumlin
