#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coupling/common/errors.hpp"
#include "coupling/statistics/quantiles.hpp"
#include "tests/exchange_files/folder.hpp"
#include "tests/study/drum_runs.hpp"

namespace drumlin {
using namespace coupling;
namespace {

using drumlin::testing::drum_run;
using drumlin::testing::message_of;

TEST(Pooling, OneRunStaysAsItIs) {
  const Scalar one = pooled("H", {{"H", 14, 0.5}});
  EXPECT_EQ(one.value, 14);
  EXPECT_EQ(one.ci99, 0.5);
}

TEST(Pooling, RunsThatAgreeNarrowTheInterval) {
  const Scalar mean = pooled("H", {{"H", 14.1, 0.6}, {"H", 13.9, 0.6}, {"H", 14, 0.6}, {"H", 14, 0.6}});
  EXPECT_NEAR(mean.value, 14, 1e-12);
  EXPECT_NEAR(*mean.ci99, 0.3, 1e-12);
}

TEST(Pooling, RunsThatDisagreeWidenIt) {
  // Two runs 4 apart with standard errors of 1: the standard error of their mean is 2 by their spread, known
  // with one degree of freedom.
  const Scalar mean = pooled("H", {{"H", 12, 2.5758293035489}, {"H", 16, 2.5758293035489}});
  EXPECT_NEAR(*mean.ci99, 2 * statistics::student_quantile_99(1), 1e-9);
}

TEST(Pooling, WhatWasNotMeasuredStandsAside) {
  EXPECT_EQ(pooled("H", {{"H", NAN, 0.5}, {"H", 14, 0.5}}).value, 14);
  EXPECT_TRUE(std::isnan(pooled("H", {{"H", NAN, 0.5}}).value));
  EXPECT_FALSE(pooled("Q", {{"Q", 14, std::nullopt}, {"Q", 15, 0.5}}).ci99.has_value());
}

TEST(Pooling, DegreesOfFreedomOfAllSpeedsAddUp) {
  // Three speeds, at each two runs 4 apart with standard errors of 1: still 2, known with three degrees.
  const std::vector<Scalar> slow{{"H", 12, 2.5758293035489}, {"H", 16, 2.5758293035489}},
      fast{{"H", 22, 2.5758293035489}, {"H", 26, 2.5758293035489}}, alone{{"H", 30, 0.5}};
  const auto means = pooled_speeds("H", {slow, fast, alone, slow});
  EXPECT_NEAR(*means[1].ci99, 2 * statistics::student_quantile_99(3), 1e-9);
  EXPECT_EQ(means[1].value, 24);
  EXPECT_EQ(*means[2].ci99, 0.5) << "one run has no spread";
}

/// Share of means of so many runs that lie within their interval; `told`: standard error by their intervals,
/// over the true one.
double coverage(int runs_of_mean, double told) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> normal(0, 1);
  int inside = 0;
  constexpr int trials = 4000;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<Scalar> runs;
    for (int r = 0; r < runs_of_mean; ++r) runs.push_back({"H", 14 + normal(engine), 2.5758293035489 * told});
    const Scalar mean = pooled("H", runs);
    inside += std::abs(mean.value - 14) <= *mean.ci99;
  }
  return inside / double(trials);
}

TEST(Pooling, IntervalHoldsTheTruth) {
  EXPECT_GT(coverage(3, 1), 0.985);  // 99 % and more, for it never narrows
  // Runs that differ by three times what they say: their spread takes over, from one degree of freedom on.
  for (const int runs : {2, 3, 4, 5}) EXPECT_NEAR(coverage(runs, 1.0 / 3), 0.99, 0.005) << runs;
}

TEST(Pooling, SeedsOfOneSpeedFormAGroup) {
  auto runs = testing::six_speeds();
  runs.push_back(drum_run(6.01));
  const auto groups = speed_groups(runs);
  ASSERT_EQ(groups.size(), 6u);
  EXPECT_EQ(groups[3].runs, (std::vector<std::size_t>{3, 6}));
  EXPECT_LT(groups[2].rotation_rpm, groups[3].rotation_rpm);
}

TEST(StudyRuns, OtherDrumsGrainsAndDefinitionsAreRefusedWithEveryDifference) {
  auto runs = testing::six_speeds();
  runs[1].identity["grains"] = "350 discs";
  runs[2].identity["settings.linear_share"] = "0.5";
  const std::string said = message_of<InputError>([&] { require_one_study(runs); });
  EXPECT_NE(said.find("grains"), std::string::npos);
  EXPECT_NE(said.find("settings.linear_share"), std::string::npos);
  EXPECT_NE(said.find(runs[1].name), std::string::npos);
}

TEST(StudyRuns, RoundingIsNoDifference) {
  auto runs = testing::six_speeds();
  runs[1].identity["drum_radius"] = "68.19";
  EXPECT_NO_THROW(require_one_study(runs));
  runs[1].identity["drum_radius"] = "69";
  EXPECT_THROW(require_one_study(runs), InputError);
}

TEST(StudyRuns, ARunNamedTwiceOrADrumAtRestIsRefused) {
  EXPECT_THROW(require_one_study({}), InputError);
  EXPECT_THROW(require_one_study({drum_run(6), drum_run(6)}), InputError);
  EXPECT_THROW(require_one_study({drum_run(0)}), InputError);
}

}  // namespace
}  // namespace drumlin
