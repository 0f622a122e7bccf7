#include "coupling/calibration/log_friction.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "coupling/calibration/run_evidence.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin {
using namespace coupling;
namespace {

constexpr double a = 0.36, b = 0.0144;

/// Layers evenly spread over ln I from 1e-4 to 1e-1, exactly on the law.
std::vector<FrictionPoint> exact_points(int count, double mu_error, double relative_I_error) {
  std::vector<FrictionPoint> points;
  for (int i = 0; i < count; ++i) {
    const double I = 1e-4 * std::pow(1e3, i / (count - 1.0));
    points.push_back({I, a + b * std::log(I), relative_I_error * I, mu_error});
  }
  return points;
}

TEST(LogLaw, PointsOnTheLawGiveItBack) {
  for (double error : {0.01, 0.0, std::numeric_limits<double>::quiet_NaN()}) {
    const FrictionFit fit = fit_log_friction(exact_points(20, error, error));
    EXPECT_NEAR(fit.law.a, a, 1e-12);
    EXPECT_NEAR(fit.law.b, b, 1e-12);
    EXPECT_NEAR(fit.rms_misfit, 0, 1e-12);
    EXPECT_NEAR(fit.law.I_min, 1e-4, 1e-16);
    EXPECT_NEAR(fit.law.I_max, 1e-1, 1e-12);
    EXPECT_EQ(fit.points, 20u);
  }
}

TEST(LogLaw, PointsWithinTheirErrorsKeepTheErrorsOfTheWeights) {
  std::vector<FrictionPoint> points;
  for (double log_I : {-1.0, 0.0, 1.0}) points.push_back({std::exp(log_I), 0.5, 0, 0.01});
  // ln I = -1, 0, 1: var(a) = s^2/3, var(b) = s^2/2, no covariance.
  const FrictionFit fit = fit_log_friction(points);
  EXPECT_NEAR(fit.law.covariance[0], 1e-4 / 3, 1e-12);
  EXPECT_NEAR(fit.law.covariance[1], 0, 1e-12);
  EXPECT_NEAR(fit.law.covariance[2], 1e-4 / 2, 1e-12);
  EXPECT_EQ(fit.intrinsic_scatter, 0);
  EXPECT_NEAR(fit.birge_ratio, 0, 1e-9);
}

TEST(LogLaw, LayerWithALargeErrorHardlyCounts) {
  auto points = exact_points(20, 0.002, 0);
  points[10].mu += 0.5;
  points[10].mu_error = 1;
  EXPECT_NEAR(fit_log_friction(points).law.b, b, 1e-5);
}

TEST(LogLaw, ErrorOfICountsThroughTheSlope) {
  // sigma_I/I = 1 at b = 0.0144 is an error of 0.0144 in mu.
  auto through_I = exact_points(20, 1e-9, 0.001);
  auto through_mu = exact_points(20, b * 0.001, 0);
  through_I[0].I_error = through_I[0].I;
  through_mu[0].mu_error = b;
  const auto first = fit_log_friction(through_I).law.covariance,
             second = fit_log_friction(through_mu).law.covariance;
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(first[i] / second[i], 1, 1e-3);
}

struct Trials {
  double within_99 = 0;  ///< share of fits whose b lies within 2.58 standard errors of the true one
  double mean_scatter = 0;
};

Trials trials(double mu_error, double hidden_scatter, double relative_I_error) {
  constexpr int count = 2000;
  std::mt19937_64 engine(11);
  std::normal_distribution<double> noise;
  Trials result;
  for (int trial = 0; trial < count; ++trial) {
    auto points = exact_points(40, mu_error, relative_I_error);
    for (auto& point : points) {
      point.mu += std::hypot(mu_error, hidden_scatter) * noise(engine);
      point.I *= std::exp(relative_I_error * noise(engine));
      point.I_error = relative_I_error * point.I;
    }
    const FrictionFit fit = fit_log_friction(points);
    if (std::abs(fit.law.b - b) <= 2.58 * std::sqrt(fit.law.covariance[2])) result.within_99 += 1.0 / count;
    result.mean_scatter += fit.intrinsic_scatter / count;
  }
  return result;
}

TEST(LogLaw, CovarianceCoversTheTruth) {
  // 2000 trials know a share of 0.99 to +-0.0067 (three standard errors); scatter estimated from 38 degrees
  // of freedom widens the true quantile from 2.58 to 2.71, which costs 0.004.
  EXPECT_GT(trials(0.01, 0, 0).within_99, 0.98);
  EXPECT_GT(trials(0.01, 0, 0.2).within_99, 0.98);
}

TEST(LogLaw, ScatterThatTheErrorsDoNotKnowIsFoundAndCounted) {
  const Trials result = trials(0.002, 0.02, 0.1);
  EXPECT_GT(result.within_99, 0.975);
  EXPECT_NEAR(result.mean_scatter, 0.02, 0.001);
}

TEST(LogLaw, TooFewLayersAreRefused) {
  EXPECT_THROW(fit_log_friction(exact_points(2, 0.01, 0)), InputError);
  auto points = exact_points(5, 0.01, 0);
  for (auto& point : points) point.I = 0.01;
  EXPECT_THROW(fit_log_friction(points), InputError);
}

TEST(LayerSelection, SurfaceWallAndRangeOfIAreLeftOut) {
  ProfileSet profiles;
  profiles.header.wall_z = -10.4;
  profiles.columns = {{"I", {}, {}}, {"mu", {}, {}}};
  for (int l = -10; l <= 2; ++l) {
    profiles.z.push_back(l);
    profiles.columns[0].value.push_back(l == -4 ? 0.5 : l == -5 ? 1e-6 : 0.01);
    profiles.columns[0].ci99.push_back(0.002576);
    profiles.columns[1].value.push_back(l == -3 ? std::numeric_limits<double>::quiet_NaN() : 0.3 + 0.01 * l);
  }
  const auto points = friction_points(profiles, {});  // of -7 ... -2: without -3, -4, -5
  ASSERT_EQ(points.size(), 3u);
  EXPECT_NEAR(points[0].mu, 0.23, 1e-12);
  EXPECT_NEAR(points[2].mu, 0.28, 1e-12);
  EXPECT_NEAR(points[0].I_error, 0.001, 1e-12);
  EXPECT_TRUE(std::isnan(points[0].mu_error));
}

TEST(LayerSelection, WithoutADrumTheBulkSpeaksUpToAnyI) {
  ProfileSet profiles;
  profiles.header.wall_z = -10.4;
  profiles.header.drum_radius = 0;
  for (const char* name : {"I", "mu", "k"}) profiles.columns.push_back({name, {}, {}});
  for (int l = -10; l <= 2; ++l) {
    profiles.z.push_back(l);
    profiles.columns[0].value.push_back(0.2);
    profiles.columns[1].value.push_back(0.5 + 0.01 * l);
    profiles.columns[2].value.push_back(1);
  }
  RunEvidence run;
  add_layers(run, profiles, {});
  EXPECT_TRUE(run.in_layers);
  ASSERT_EQ(run.layers.size(), 3u);  // of -6, -5, -4: 4 d from the wall and from the surface
  EXPECT_NEAR(run.layers[0].mu, 0.44, 1e-12);
  EXPECT_NEAR(run.layers[2].mu, 0.46, 1e-12);
  profiles.header.drum_radius = 60;
  RunEvidence drum;
  add_layers(drum, profiles, {});
  EXPECT_FALSE(drum.in_layers);
  EXPECT_TRUE(drum.layers.empty());  // up to I = 0.1
}

}  // namespace
}  // namespace drumlin
