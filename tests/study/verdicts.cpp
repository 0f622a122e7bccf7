#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "coupling/study/paper_verdicts.hpp"
#include "tests/support/data_folder.hpp"

namespace drumlin {
using namespace coupling;
namespace {

const std::filesystem::path paper = drumlin::test::data_folder() / "paper";
using Expects = PaperEntry::Expects;

PaperEntry entry(Expects expects, double value = 0, std::optional<double> half_width = std::nullopt) {
  return {"some", 6.0, expects, value, half_width, "Fig. 1", ""};
}

Verdict verdict_of(const PaperEntry& said, double ours, std::optional<double> ci99, double scale = 1,
                   double limit = 1) {
  return verdict_on(said, {{"some", ours, ci99}, scale, limit}).verdict;
}

TEST(Verdict, AValueAgreesInsideTheIntervalIsNearWithinTenPercentElseDiffers) {
  EXPECT_EQ(verdict_of(entry(Expects::value, 14.6), 15.0, 0.5), Verdict::agrees);
  EXPECT_EQ(verdict_of(entry(Expects::value, 14.6), 15.6, 0.5), Verdict::near);
  EXPECT_EQ(verdict_of(entry(Expects::value, 14.6), 18.2, 0.9), Verdict::differs);
  EXPECT_EQ(verdict_of(entry(Expects::value, 14.6), NAN, 0.9), Verdict::not_measured);
  EXPECT_EQ(verdict_of(entry(Expects::value, 14.6), 14.7, std::nullopt), Verdict::near)
      << "without an interval nothing agrees";
}

TEST(Verdict, ThePapersOwnHalfWidthCounts) {
  EXPECT_EQ(verdict_of(entry(Expects::value, 3, 0.3), 3.5, 0.25), Verdict::agrees);
  EXPECT_EQ(verdict_of(entry(Expects::value, 3), 3.5, 0.25), Verdict::differs);
}

TEST(Verdict, AWideIntervalLeavesItOpen) {
  EXPECT_EQ(verdict_on(entry(Expects::value, 3), {{"some", 3.4, 1.5}}).reason, Reason::inside_wide_interval);
  EXPECT_EQ(verdict_of(entry(Expects::value, 3), 3.4, 1.5), Verdict::open);
  EXPECT_EQ(verdict_of(entry(Expects::zero), 0.1, 0.3), Verdict::open);
  EXPECT_EQ(verdict_on(entry(Expects::value, 3), {{"some", 3.4, 0.5}}).reason, Reason::inside_interval);
}

TEST(Verdict, WhatTheSceneGivesIsNoAgreement) {
  PaperEntry flow_rate = entry(Expects::value, 28);
  flow_rate.quantity = "Q";
  EXPECT_EQ(verdict_of(flow_rate, 28, 0.5), Verdict::imposed);
  EXPECT_EQ(verdict_of(flow_rate, NAN, 0.5), Verdict::not_measured);
}

TEST(Verdict, ZeroIsJudgedAgainstItsScale) {
  EXPECT_EQ(verdict_of(entry(Expects::zero), 0.01, 0.02, 0.28), Verdict::agrees);
  EXPECT_EQ(verdict_of(entry(Expects::zero), 0.02, 0.01, 0.28), Verdict::near);
  EXPECT_EQ(verdict_of(entry(Expects::zero), 0.07, 0.04, 0.28), Verdict::differs);
}

TEST(Verdict, SignsNeedAnIntervalThatExcludesZero) {
  EXPECT_EQ(verdict_of(entry(Expects::not_zero), -0.2, 0.05), Verdict::agrees);
  EXPECT_EQ(verdict_of(entry(Expects::not_zero), -0.2, 0.3), Verdict::near);
  EXPECT_EQ(verdict_of(entry(Expects::positive), 0.2, 0.05), Verdict::agrees);
  EXPECT_EQ(verdict_of(entry(Expects::positive), -0.2, 0.05), Verdict::differs);
  EXPECT_EQ(verdict_on(entry(Expects::positive), {{"some", 0.2, 0.3}}).reason, Reason::unresolved);
}

TEST(Verdict, CollapseAndItsAbsence) {
  EXPECT_EQ(verdict_of(entry(Expects::collapse), 1.2, std::nullopt, 1, 1.7), Verdict::agrees);
  EXPECT_EQ(verdict_of(entry(Expects::collapse), 2.0, std::nullopt, 1, 1.7), Verdict::near);
  EXPECT_EQ(verdict_of(entry(Expects::collapse), 4.0, std::nullopt, 1, 1.7), Verdict::differs);
  EXPECT_EQ(verdict_of(entry(Expects::no_collapse), 4.0, std::nullopt, 1, 1.7), Verdict::agrees);
  EXPECT_EQ(verdict_of(entry(Expects::no_collapse), 0.8, std::nullopt, 1, 1.7), Verdict::differs);
}

TEST(PaperEntries, TableOneHasEighteenAndEveryEntryNamesItsPlace) {
  const auto entries = paper_entries_of(paper);
  int table_one = 0;
  for (const PaperEntry& one : entries) {
    EXPECT_FALSE(one.source.empty()) << one.quantity;
    EXPECT_FALSE(one.quantity.empty());
    if (one.expects == Expects::value) {
      EXPECT_TRUE(std::isfinite(one.value)) << one.quantity;
    }
    table_one += one.source == "Table I" && one.quantity != "theta_com_deg";
  }
  EXPECT_EQ(table_one, 18);
}

TEST(PaperEntries, NoQuestionIsAskedTwice) {
  std::set<std::pair<std::string, double>> asked;
  for (const PaperEntry& one : paper_entries_of(paper))
    EXPECT_TRUE(asked.emplace(one.quantity, one.rotation_rpm.value_or(0)).second) << one.quantity;
}

TEST(PaperEntries, ANumberAlongTheUpslopeAxisChangesItsSign) {
  for (const PaperEntry& one : paper_entries_of(paper))
    if (one.quantity.starts_with("dk_dx")) {
      EXPECT_EQ(one.value, 0.05);
    }
}

}  // namespace
}  // namespace drumlin
