// The fast half of the continuum's rows in the table that `drumlin hardcases` shows, one test per case.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <set>

#include "continuum/hardcases/flow_hard_cases.hpp"

namespace drumlin {

/// For the names that ctest shows.
void PrintTo(const HardCase& hard, std::ostream* out) { *out << hard.name; }

namespace {

class FastFlowHardCase : public testing::TestWithParam<HardCase> {};

TEST_P(FastFlowHardCase, HasItsKnownOutcome) {
  const HardResult result = run_hard_case(GetParam());
  EXPECT_FALSE(result.checks.empty());
  for (const HardCheck& check : result.checks)
    EXPECT_TRUE(check.holds()) << check.what << ": expected " << check.expected << ", got " << check.got
                               << ", tolerance " << check.tolerance << " (" << check.reason << ')';
}

std::vector<HardCase> fast_cases() {
  std::vector<HardCase> fast;
  for (const HardCase& hard : flow_hard_cases())
    if (hard.fast) fast.push_back(hard);
  return fast;
}

std::string test_name(const testing::TestParamInfo<HardCase>& instance) {
  std::string name = instance.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Table, FastFlowHardCase, testing::ValuesIn(fast_cases()), test_name);

TEST(FlowHardCases, HaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const HardCase& hard : flow_hard_cases()) EXPECT_TRUE(names.insert(hard.name).second) << hard.name;
}

}  // namespace
}  // namespace drumlin
