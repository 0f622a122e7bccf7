#pragma once
// The fast half of a table of hard cases, one test per case: what both simulators' tests instantiate.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "tests/hardcases/hard_case.hpp"

namespace drumlin {

/// For the names that ctest shows.
inline void PrintTo(const HardCase& hard, std::ostream* out) { *out << hard.name; }

namespace testing_hard_cases {

class FastHardCase : public ::testing::TestWithParam<HardCase> {};

TEST_P(FastHardCase, HasItsKnownOutcome) {
  const HardResult result = run_hard_case(GetParam());
  EXPECT_FALSE(result.checks.empty());
  for (const HardCheck& check : result.checks)
    EXPECT_TRUE(check.holds()) << check.what << ": expected " << check.expected << ", got " << check.got
                               << ", tolerance " << check.tolerance << " (" << check.reason << ')';
}

inline std::vector<HardCase> fast_ones(const std::vector<HardCase>& cases) {
  std::vector<HardCase> fast;
  std::copy_if(cases.begin(), cases.end(), std::back_inserter(fast),
               [](const HardCase& hard) { return hard.fast; });
  return fast;
}

inline std::string test_name(const ::testing::TestParamInfo<HardCase>& instance) {
  std::string name = instance.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

inline void expect_names_of_their_own(const std::vector<HardCase>& cases) {
  std::set<std::string> names;
  for (const HardCase& hard : cases) EXPECT_TRUE(names.insert(hard.name).second) << hard.name;
}

}  // namespace testing_hard_cases
}  // namespace drumlin
