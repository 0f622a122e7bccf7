// The fast half of the table that `drumlin hardcases` shows, one test per case, and what judges it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>

#include "particles/hardcases/hard_case.hpp"
#include "particles/hardcases/trends.hpp"

namespace drumlin {

/// For the names that ctest shows.
void PrintTo(const HardCase& hard, std::ostream* out) { *out << hard.name; }

namespace {

class FastHardCase : public testing::TestWithParam<HardCase> {};

TEST_P(FastHardCase, HasItsKnownOutcome) {
  const HardResult result = run_hard_case(GetParam());
  EXPECT_FALSE(result.checks.empty());
  for (const HardCheck& check : result.checks)
    EXPECT_TRUE(check.holds()) << check.what << ": expected " << check.expected << ", got " << check.got
                               << ", tolerance " << check.tolerance << " (" << check.reason << ')';
}

std::vector<HardCase> fast_cases() {
  std::vector<HardCase> fast;
  for (const HardCase& hard : hard_cases())
    if (hard.fast) fast.push_back(hard);
  return fast;
}

std::string test_name(const testing::TestParamInfo<HardCase>& instance) {
  std::string name = instance.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Table, FastHardCase, testing::ValuesIn(fast_cases()), test_name);

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

TEST(HardResult, WithoutChecksHasNotPassed) { EXPECT_FALSE(HardResult{}.passed()); }

TEST(HardCases, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const HardCase& hard : hard_cases()) EXPECT_TRUE(names.insert(hard.name).second) << hard.name;
}

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
}  // namespace drumlin
