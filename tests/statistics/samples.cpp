#include "coupling/core/statistics/samples.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace drumlin::statistics {
namespace {

TEST(Samples, MeanAndVarianceByHand) {
  const std::vector<double> values{3, 5, 4, 8};
  EXPECT_DOUBLE_EQ(mean(values), 5);
  EXPECT_DOUBLE_EQ(variance(values), (4 + 0 + 1 + 9) / 3.0);
}

TEST(Samples, TooLittleIsNotANumber) {
  EXPECT_TRUE(std::isnan(mean({})));
  EXPECT_TRUE(std::isnan(variance(std::vector<double>{1.0})));
}

TEST(Samples, AWeightIsAsManyRepetitions) {
  // 2 with a quarter of the variance counts like four of them.
  const std::vector<double> values{2, 7}, variances{0.25, 1};
  const std::vector<double> repeated{2, 2, 2, 2, 7};
  const WeightedMean found = weighted_mean(values, variances);
  EXPECT_DOUBLE_EQ(found.value, mean(repeated));
  EXPECT_DOUBLE_EQ(found.variance, 1.0 / 5);
}

TEST(Samples, EqualVariancesGiveThePlainMean) {
  const std::vector<double> values{1, 4, 9, 16};
  const WeightedMean found = weighted_mean(values, std::vector<double>(4, 9.0));
  EXPECT_DOUBLE_EQ(found.value, mean(values));
  EXPECT_DOUBLE_EQ(found.variance, 9.0 / 4);
}

}  // namespace
}  // namespace drumlin::statistics
