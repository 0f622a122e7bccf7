// What drumlin-flow hands to drumlin: rows of hard cases, line by line.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/json/hard_case_json.hpp"

namespace drumlin::apps {
namespace {

TEST(HardCaseRow, IsTheSameAfterItsTripThroughJson) {
  const HardCase hard{"name", "outcome", true, {}};
  const HardResult result{{equals("a", 1, 1.5, 0.1, "why"), at_most("b", 2, 1, ""), at_least("c", 3, 4, "")},
                          0.5};
  const HardRow row = hard_row(nlohmann::ordered_json::parse(to_json(hard, result).dump()));
  EXPECT_EQ(row.hard.name, "name");
  EXPECT_EQ(row.hard.outcome, "outcome");
  EXPECT_TRUE(row.hard.fast);
  EXPECT_EQ(row.result.seconds, 0.5);
  ASSERT_EQ(row.result.checks.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(row.result.checks[k].relation, result.checks[k].relation);
    EXPECT_EQ(row.result.checks[k].holds(), result.checks[k].holds());
    EXPECT_EQ(row.result.checks[k].reason, result.checks[k].reason);
  }
}

TEST(HardCaseRow, StillFailsWithWhatIsNotANumber) {
  const HardResult result{{at_most("a", 1, std::nan(""), "")}, 0};
  const HardRow row = hard_row(nlohmann::ordered_json::parse(to_json({}, result).dump()));
  EXPECT_TRUE(std::isnan(row.result.checks[0].got));
  EXPECT_FALSE(row.result.passed());
}

}  // namespace
}  // namespace drumlin::apps
