// What a run warns of at its end and in run.json.
#include <gtest/gtest.h>

#include "apps/commands/run_report.hpp"
#include "tests/scene/example.hpp"
#include "tests/support/says.hpp"

namespace drumlin {
namespace {

// A heavy disc on light ones: half a diameter in one step is 0.005 in the mean of a hundred contacts and
// 0.0001 in that of fifty steps, which no other warning sees.
TEST(RunWarnings, DeepestOverlapOfAStepIsTold) {
  const particles::Scene scene = particles::parse_scene(testing::example_scene, "s.toml");
  const particles::Simulation simulation(scene);
  particles::RunTotals totals;
  const auto warned = [&] { return apps::run_warnings({scene, simulation, totals, 1}); };
  totals.overlap_max = 0.2;
  EXPECT_TRUE(warned().empty());
  totals.overlap_max = 0.48;
  ASSERT_EQ(warned().size(), 1u);
  expect_has(warned()[0], "overlapped by 0.48 d in a step, more than 0.25 d");
  totals.overlap_sum = 0.002;  // of one step: the warning of the mean says both
  ASSERT_EQ(warned().size(), 1u);
  expect_has(warned()[0], "0.002 d in the mean, and by 0.48 d at worst");
}

}  // namespace
}  // namespace drumlin
