// The fast half of the table that hard_cases shows, one test per case, and what judges it.
#include <cmath>

#include "tests/hardcases/particles/trends.hpp"
#include "tests/hardcases/registry.hpp"
#include "tests/support/hard_case_tests.hpp"

namespace drumlin::testing_hard_cases {

INSTANTIATE_TEST_SUITE_P(Table, FastHardCase, ::testing::ValuesIn(fast_ones(particle_hard_cases())),
                         test_name);

namespace {

TEST(HardCheck, FailsOnWhatIsNotANumber) {
  const double nan = std::nan("");
  EXPECT_FALSE(equals("", 0, nan, 1, "").holds());
  EXPECT_FALSE(at_most("", 0, nan, "").holds());
  EXPECT_FALSE(at_least("", 0, nan, "").holds());
  EXPECT_FALSE(at_most("", 1, 1.5, "").holds());
  EXPECT_FALSE(at_least("", 1, 0.5, "").holds());
  EXPECT_FALSE(equals("", 1, 1.5, 0.4, "").holds());
  EXPECT_TRUE(equals("", 1, 1.5, 0.6, "").holds());
}

TEST(HardCheck, FailsOnTheLargestOfValuesOfWhichOneIsNotANumber) {
  const double nan = std::nan("");
  EXPECT_EQ(larger(1, 2), 2);
  EXPECT_EQ(larger(2, 1), 2);
  EXPECT_TRUE(std::isnan(larger(nan, 1)));
  EXPECT_TRUE(std::isnan(larger(1, nan)));
}

TEST(HardResult, WithoutChecksHasNotPassed) { EXPECT_FALSE(HardResult{}.passed()); }

TEST(HardCases, HaveNamesOfTheirOwn) { expect_names_of_their_own(particle_hard_cases()); }

TEST(Trend, OfALineIsItsSlope) {
  std::vector<double> line;
  for (int k = 0; k < 90; ++k) line.push_back(3 + 0.25 * k);
  const Trend trend = trend_of(line);
  EXPECT_NEAR(trend.slope, 0.25, 1e-12);
  EXPECT_NEAR(trend.error, 0, 1e-12);
}

TEST(Trend, OfAnAlternationHasNoneWithinItsError) {
  std::vector<double> values;
  for (int k = 0; k < 90; ++k) values.push_back(k / 5 % 2);
  const Trend trend = trend_of(values);
  EXPECT_LT(std::abs(trend.slope), 2 * trend.error);
}

}  // namespace
}  // namespace drumlin::testing_hard_cases
