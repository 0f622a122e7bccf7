#include "particles/measurement/frame/intervals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "coupling/core/statistics/quantiles.hpp"

namespace drumlin {
using namespace particles;
namespace {

TEST(Intervals, BatchesAreContiguousAndAlmostEqual) {
  std::vector<int> size(20, 0);
  std::size_t before = 0;
  for (std::size_t i = 0; i < 407; ++i) {
    const std::size_t batch = batch_of(i, 407, 20);
    EXPECT_GE(batch, before);
    before = batch;
    ++size.at(batch);
  }
  for (int n : size) EXPECT_TRUE(n == 20 || n == 21);
}

TEST(Intervals, JackknifeOfAMeanIsTheMethodOfBatchMeans) {
  // Three batches with means 3, 5, 4: standard error 1/sqrt(3). Their neighbours are correlated negatively,
  // which does not count. Half of three batches leave one degree of freedom.
  const std::vector<double> series{1, 5, 2, 8, 4, 4};
  EXPECT_NEAR(mean_ci99(series, 3), statistics::student_quantile_99(1) / std::sqrt(3.0), 1e-12);
}

TEST(Intervals, NeighboursThatGoTogetherWidenTheInterval) {
  // Means -3, -1, 1, 3: squares 20, neighbours 3 - 1 + 3 = 5; variance of the mean (20 + 2 5)/(4 3).
  EXPECT_NEAR(mean_ci99(std::vector<double>{-3, -1, 1, 3}, 4), interval_factor(4) * std::sqrt(30.0 / 12),
              1e-12);
}

TEST(Intervals, TooLittleGivesNoInterval) {
  EXPECT_TRUE(std::isnan(mean_ci99(std::vector<double>{1.0})));
  EXPECT_TRUE(
      std::isnan(jackknife_ci99(std::vector<double>{1.0, std::numeric_limits<double>::quiet_NaN(), 2.0})));
}

/// Shares of 99 % intervals of the mean that hold the true mean 0, over many AR(1) series of 400 values.
struct Coverage {
  double batches, independent;
};

Coverage coverage_of_autoregression(double memory) {
  constexpr int trials = 4000, length = 400;
  std::mt19937_64 engine(7);
  std::normal_distribution<double> noise;
  int batch_hits = 0, independent_hits = 0;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<double> series(length);
    double value = noise(engine) / std::sqrt(1 - memory * memory);
    double sum = 0, squares = 0;
    for (double& entry : series) {
      entry = value;
      sum += value;
      squares += value * value;
      value = memory * value + noise(engine);
    }
    const double mean = sum / length;
    if (std::abs(mean) <= mean_ci99(series)) ++batch_hits;
    if (std::abs(mean) <= 2.588 * std::sqrt((squares / length - mean * mean) / (length - 1)))
      ++independent_hits;
  }
  return {batch_hits / static_cast<double>(trials), independent_hits / static_cast<double>(trials)};
}

// Four thousand trials know a share of 0.99 to +-0.005 (three standard errors). 400 values in 20 batches
// of 20.

TEST(Intervals, HoldTheMeanOfACorrelatedSeries) {
  EXPECT_NEAR(coverage_of_autoregression(0.0).batches, 0.995, 0.005);  // a little wider than needed
  const Coverage correlated = coverage_of_autoregression(0.5);         // over 2 values
  EXPECT_NEAR(correlated.batches, 0.99, 0.007);
  EXPECT_LT(correlated.independent, 0.90);  // what counting every value as independent would give
  EXPECT_GT(coverage_of_autoregression(0.95).batches, 0.955);  // over 20, a whole batch
}

}  // namespace
}  // namespace drumlin
