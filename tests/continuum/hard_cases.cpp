// The fast half of the continuum's rows in the table that flow_hard_cases shows.
#include "tests/hardcases/registry.hpp"
#include "tests/support/hard_case_tests.hpp"

namespace drumlin::testing_hard_cases {

INSTANTIATE_TEST_SUITE_P(Table, FastHardCase, ::testing::ValuesIn(fast_ones(flow_hard_cases())), test_name);

TEST(FlowHardCases, HaveNamesOfTheirOwn) { expect_names_of_their_own(flow_hard_cases()); }

}  // namespace drumlin::testing_hard_cases
