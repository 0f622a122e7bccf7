// Limits of a study: read from files, judged with the noise floor between seeds, on runs and flows made from
// known laws.
#include <gtest/gtest.h>

#include "coupling/common/errors.hpp"
#include "coupling/study/judged_limits.hpp"
#include "tests/exchange_files/folder.hpp"
#include "tests/study/flow_runs.hpp"
#include "tests/support/data_folder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace drumlin {
using namespace coupling;
namespace {

using testing::drum_run;
using testing::DrumLaws;
using testing::flow_run;
using testing::message_of;

JudgedSide run_side(double rpm, const std::string& name, const DrumLaws& laws = {}) {
  const StudyRun run = drum_run(rpm, laws);
  return {name, rpm, {run.profiles, run.scalars, {}}, 200, ""};
}

JudgedSide flow_side(double rpm, const DrumLaws& laws = {}, double lower = 0) {
  const StudyFlow flow = flow_run(rpm, laws, lower);
  return {flow.name, rpm, flow.side, flow.cpu_seconds, flow.start};
}

Limit field_limit(const std::string& quantity, const std::string& zone, double must) {
  return {quantity, "centre", zone, "relative", must, must / 2, std::nullopt};
}

DrumLaws with_mu(double mu_a) {
  DrumLaws laws;
  laws.mu_a = mu_a;
  return laws;
}

const LimitRow& row(const JudgedLimits& judged, const std::string& quantity,
                    Registration by = Registration::axis) {
  for (const LimitRow& candidate : judged.rows)
    if (candidate.limit.quantity == quantity && candidate.registration == by) return candidate;
  throw InputError("no " + quantity);
}

TEST(Limits, TheOnesOfTheBedAreRead) {
  const Limits limits = read_limits(test::data_folder() / "limits" / "bed.toml");
  EXPECT_EQ(limits.limits.size(), 16u);
  EXPECT_EQ(limits.floor_factor, 1.5);
}

TEST(Limits, WhatDoesNotBelongTogetherIsRefusedWithItsPlace) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "limits.toml";
  const auto message = [&](const std::string& entry) {
    std::ofstream(file) << "format = \"drumlin-limits-1\"\n[[limits]]\nquantity = \"H\"\n" << entry;
    return message_of<InputError>([&] { read_limits(file); });
  };
  EXPECT_NE(message("where = \"scalar\"\nzone = \"all\"\nmeasure = \"difference\"\nmust = 1\naim = 1\n")
                .find("do not belong together"),
            std::string::npos);
  EXPECT_NE(
      message("where = \"somewhere\"\nmeasure = \"difference\"\nmust = 1\naim = 1\n").find("limits.0.where"),
      std::string::npos);
  EXPECT_NE(
      message("where = \"scalar\"\nmeasure = \"difference\"\nmust = -1\naim = 1\n").find("limits.0.must"),
      std::string::npos);
}

TEST(JudgedLimits, ErrorsAreMeansOverTheRunsThatCalibratedNothing) {
  // mu of the runs is 0.35 and 0.45 about the flow's; the one that calibrated shows the flow's and does not
  // judge.
  const JudgedLimits judged = judged_limits(
      {.limits = {field_limit("sigma_xz", "flowing", 0.2)}},
      {run_side(6, "seed1"), run_side(6, "seed2", with_mu(0.40)), run_side(6, "seed3", with_mu(0.30))},
      {flow_side(6)}, {"seed1"});
  EXPECT_EQ(judged.judged_by, (std::vector<std::string>{"seed2", "seed3"}));
  EXPECT_TRUE(judged.calibrated_by.empty());
  ASSERT_EQ(judged.rows.size(), 2u);  // by the axis and by the surface
  const LimitCell& cell = row(judged, "sigma_xz").cells.at(0);
  EXPECT_GT(cell.value, 0.1);
  EXPECT_NEAR(cell.floor, 0.1 / 0.34, 0.06);  // seed against seed: 0.1 of mu apart
  EXPECT_NEAR(cell.limit, 1.5 * cell.floor, 1e-12);
  EXPECT_TRUE(cell.met);
  EXPECT_EQ(row(judged, "sigma_xz").must, Target::Outcome::met);
}

TEST(JudgedLimits, ASpeedWithOneRunBorrowsTheFloorOfTheOthers) {
  const JudgedLimits judged =
      judged_limits({.limits = {field_limit("sigma_xz", "flowing", 0.01)}},
                    {run_side(6, "a"), run_side(6, "b", with_mu(0.352)), run_side(3, "c", with_mu(0.5))},
                    {flow_side(6), flow_side(3)}, {});
  EXPECT_EQ(judged.speeds, (std::vector<double>{3, 6}));
  const LimitRow& found = row(judged, "sigma_xz");
  EXPECT_TRUE(found.cells[0].floor_of_others);
  EXPECT_FALSE(found.cells[1].floor_of_others);
  EXPECT_EQ(found.cells[0].floor, found.cells[1].floor);
  EXPECT_FALSE(found.cells[0].met);
  EXPECT_TRUE(found.cells[1].met);
  EXPECT_EQ(found.must, Target::Outcome::missed);
}

TEST(JudgedLimits, AWorstSpeedIsJudgedApartFromTheMean) {
  Limit limit = field_limit("sigma_xz", "flowing", 0.1);
  limit.must_worst = 0.2;
  const auto judged = [&](double mu) {
    return judged_limits({.limits = {limit}}, {run_side(6, "a"), run_side(5, "b", with_mu(mu))},
                         {flow_side(6), flow_side(5)}, {});
  };
  EXPECT_EQ(row(judged(0.40), "sigma_xz").must, Target::Outcome::met);  // 0 and 0.15: mean 0.08
  EXPECT_EQ(row(judged(0.50), "sigma_xz").must, Target::Outcome::missed);
}

TEST(JudgedLimits, ScalarsAreCountedWhereTheIntervalsHoldThem) {
  DrumLaws other;
  other.lambda = 6;
  const Limit limit{"lambda", "scalar", "", "inside_interval", 0.5, 1, std::nullopt};
  const JudgedLimits judged = judged_limits({.limits = {limit}}, {run_side(6, "a"), run_side(5, "b", other)},
                                            {flow_side(6), flow_side(5)}, {});
  const LimitRow& found = row(judged, "lambda");
  EXPECT_FALSE(found.cells[0].met);
  EXPECT_EQ(found.must, found.cells[1].met ? Target::Outcome::met : Target::Outcome::missed);
  EXPECT_EQ(found.aim, Target::Outcome::missed);
}

TEST(JudgedLimits, BothRegistrationsStandSideBySide) {
  const Limit limit{"H", "scalar", "", "difference", 0.5, 0.1, std::nullopt};
  const JudgedLimits judged =
      judged_limits({.limits = {limit}}, {run_side(6, "a")}, {flow_side(6, {}, -1)}, {});
  EXPECT_NEAR(row(judged, "H", Registration::surface).cells[0].value -
                  row(judged, "H", Registration::axis).cells[0].value,
              -1,
              0.2);  // the flow's surface lies 1 d farther below the axis: the same flow, less deep below it
}

TEST(JudgedLimits, CostsGoByTheStartAndWallsNeedMaps) {
  const Limit cold{"seconds_cold", "cost", "", "value", 4, 1, std::nullopt},
      neighbour{"seconds_neighbour", "cost", "", "value", 4, 1, std::nullopt},
      wall{"traction_ratio", "wall", "", "rms", 0.1, 0.05, std::nullopt};
  const JudgedLimits judged =
      judged_limits({.limits = {cold, neighbour, wall}}, {run_side(6, "a")}, {flow_side(6)}, {"a"});
  EXPECT_EQ(judged.calibrated_by, (std::vector<std::string>{"a"}));
  EXPECT_EQ(row(judged, "seconds_cold").must, Target::Outcome::missed);  // 5 s
  EXPECT_EQ(row(judged, "seconds_neighbour").must, Target::Outcome::not_measured);
  EXPECT_EQ(row(judged, "traction_ratio").must, Target::Outcome::not_measured);
}

// A uniform stress: shear over normal traction follows from the angle alone.
TEST(TractionRatios, OfAUniformStressTurnWithTheWall) {
  FieldMap map;
  map.grid = {-60, -60, 1, 1, 121, 121};
  map.header.axis_depth = 4;
  map.header.drum_radius = 50;
  const double p = 2, shear = 0.5;
  for (const auto& [name, value] :
       {std::pair("sigma_xx", p), std::pair("sigma_zz", p), std::pair("sigma_xz", shear)})
    map.fields.push_back({name, std::vector<double>(map.grid.nodes(), value), {}});
  const std::vector<double> ratios = traction_ratios(map);
  ASSERT_EQ(ratios.size(), 19u);
  EXPECT_NEAR(ratios[9], shear / p, 1e-12);  // straight below the axis: sigma_xz/sigma_zz
  EXPECT_NEAR(ratios[0], 0, 1e-12);          // 45 deg: a principal axis
  EXPECT_NEAR(ratios[18], 0, 1e-12);
}

}  // namespace
}  // namespace drumlin
