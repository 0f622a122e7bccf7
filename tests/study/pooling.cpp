#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "coupling/exchange/errors.hpp"
#include "tests/exchange_files/folder.hpp"
#include "tests/study/drum_runs.hpp"

namespace drumlin {
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
  // Two runs 4 apart with standard errors of 1: chi^2 = 8 for one degree of freedom.
  const Scalar mean = pooled("H", {{"H", 12, 2.5758293035489}, {"H", 16, 2.5758293035489}});
  EXPECT_NEAR(*mean.ci99, 2.5758293035489 / std::sqrt(2) * std::sqrt(8), 1e-9);
}

TEST(Pooling, WhatWasNotMeasuredStandsAside) {
  EXPECT_EQ(pooled("H", {{"H", NAN, 0.5}, {"H", 14, 0.5}}).value, 14);
  EXPECT_TRUE(std::isnan(pooled("H", {{"H", NAN, 0.5}}).value));
  EXPECT_FALSE(pooled("Q", {{"Q", 14, std::nullopt}, {"Q", 15, 0.5}}).ci99.has_value());
}

TEST(Pooling, IntervalHoldsTheTruth) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> normal(0, 1);
  int inside = 0;
  constexpr int trials = 4000;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<Scalar> runs;
    for (int r = 0; r < 3; ++r) runs.push_back({"H", 14 + normal(engine), 2.5758293035489});
    const Scalar mean = pooled("H", runs);
    inside += std::abs(mean.value - 14) <= *mean.ci99;
  }
  EXPECT_GT(inside / double(trials), 0.985);  // 99 % and more, for it never narrows
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
