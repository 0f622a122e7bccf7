#include "coupling/calibration/robust_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coupling/exchange/errors.hpp"

namespace drumlin {
namespace {

const FrictionCoefficients truth{.a = 0.33, .b = 0.011, .c = 0.6};

/// Layers of I from 1e-4 to 0.1 with normal noise.
std::vector<FrictionPoint> layers(const FrictionCoefficients& law, double noise, int count, unsigned seed,
                                  bool errors_known = true) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<FrictionPoint> points;
  for (int i = 0; i < count; ++i) {
    const double I = 1e-4 * std::pow(1e3, (i + 0.5) / count);
    points.push_back({I, friction(law, I) + noise * normal(random), 0, errors_known ? noise : NAN});
  }
  return points;
}

TEST(RobustLaw, IsExactForPointsOnIt) {
  for (const bool known : {true, false}) {
    const RobustFriction fit = fit_friction(layers(truth, 0, 30, 1, known), FrictionForm::log_linear);
    EXPECT_NEAR(fit.law.a, truth.a, 1e-9);
    EXPECT_NEAR(fit.law.b, truth.b, 1e-9);
    EXPECT_NEAR(fit.law.c, truth.c, 1e-8);
    EXPECT_EQ(fit.intrinsic_scatter, 0);
  }
}

TEST(RobustLaw, IsHardlyMovedByLayersThatAreFarOff) {
  auto points = layers(truth, 0.003, 60, 2);
  const FrictionCoefficients before = fit_friction(points, FrictionForm::log_linear).law;
  for (const std::size_t bad : {3, 20, 41, 57}) points[bad].mu += 0.3;
  const FrictionCoefficients after = fit_friction(points, FrictionForm::log_linear).law;
  for (const double I : {1e-3, 1e-2, 0.08}) EXPECT_NEAR(friction(after, I), friction(before, I), 0.003) << I;
}

TEST(RobustLaw, FindsTheScatterThatErrorsDoNotExplain) {
  auto points = layers(truth, 0.01, 400, 3);
  for (FrictionPoint& point : points) point.mu_error = 0.006;
  EXPECT_NEAR(fit_friction(points, FrictionForm::log_linear).intrinsic_scatter, 0.008, 0.001);
}

TEST(RobustLaw, HoldsASlopeThatWouldBeNegativeAtNought) {
  const FrictionCoefficients falling{.a = 0.3, .b = 0.02, .c = -0.5};
  const RobustFriction fit = fit_friction(layers(falling, 0, 40, 4), FrictionForm::log_linear);
  EXPECT_EQ(fit.law.c, 0);
  EXPECT_GT(fit.law.b, 0);
}

TEST(RobustLaw, BandOfItsDrawsHoldsTheTruthAsOftenAsItSays) {
  int inside = 0, asked = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const auto points = layers(truth, 0.01, 60, 100 + seed);
    const auto laws = bootstrapped({points}, FrictionForm::log_linear, 100);
    for (const double I : {1e-3, 1e-2, 0.05}) {
      const FrictionBand band = band_at(laws, I, 0.9);
      inside += band.low <= friction(truth, I) && friction(truth, I) <= band.high;
      ++asked;
    }
  }
  EXPECT_NEAR(static_cast<double>(inside) / asked, 0.9, 0.1);
}

TEST(RobustLaw, DrawsAreTheSameEachTime) {
  const auto points = layers(truth, 0.01, 30, 5);
  const auto once = bootstrapped({points, points}, FrictionForm::log, 5),
             again = bootstrapped({points, points}, FrictionForm::log, 5);
  for (std::size_t k = 0; k < once.size(); ++k) EXPECT_EQ(once[k].b, again[k].b);
}

TEST(RobustLaw, NeedsMorePointsThanCoefficients) {
  EXPECT_THROW(fit_friction(layers(truth, 0, 3, 1), FrictionForm::log_linear), InputError);
  EXPECT_THROW(fit_friction({{0.1, 0.3, 0, 0}, {0.1, 0.31, 0, 0}, {0.1, 0.32, 0, 0}}, FrictionForm::log),
               InputError);
}

}  // namespace
}  // namespace drumlin
