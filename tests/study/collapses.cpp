#include <gtest/gtest.h>

#include <cmath>

#include "coupling/study/collapse.hpp"
#include "tests/study/drum_runs.hpp"

namespace drumlin {
using namespace coupling;
namespace {

using drumlin::testing::DrumLaws;
using drumlin::testing::six_speeds;

Collapse collapse_with(const DrumLaws& laws, const std::string& column = "mu") {
  const auto runs = six_speeds(laws);
  return collapse_of(column, runs, speed_groups(runs));
}

TEST(Collapse, OneLawOfIIsOneCurve) {
  const Collapse found = collapse_with({});
  EXPECT_TRUE(found.collapse);
  EXPECT_LT(found.ratio, 0.05);  // interpolation in ln I is exact for a + b ln I
  EXPECT_NEAR(found.limit, std::sqrt(15.086 / 5), 0.01);
  EXPECT_GE(found.points.size(), 8u);
}

TEST(Collapse, ALawThatMovesWithTheSpeedIsNot) {
  // 0.004 per rpm: 0.052 between 2 and 15 rpm, where the standard error of mu is 0.003.
  DrumLaws laws;
  laws.mu_per_rpm = 0.004;
  const Collapse found = collapse_with(laws);
  EXPECT_FALSE(found.collapse);
  EXPECT_GT(found.ratio, 3);
  EXPECT_NEAR(found.spread, 0.019, 0.002);  // standard deviation of 0.004 (2, 4, 5, 6, 10, 15)
}

TEST(Collapse, OneSpeedAloneSaysNothing) {
  const std::vector<StudyRun> runs{testing::drum_run(6)};
  const Collapse found = collapse_of("mu", runs, speed_groups(runs));
  EXPECT_TRUE(std::isnan(found.ratio));
  EXPECT_FALSE(found.collapse);
}

TEST(InertialCurve, LayersAtSurfaceAndWallAndBelowTheResolvedShearStandAside) {
  StudyRun run = testing::drum_run(6);
  auto& rate = run.profiles.columns[2];
  ASSERT_EQ(rate.name, "shear_rate");
  for (std::size_t l = 0; l < run.profiles.z.size(); ++l)
    if (run.profiles.z[l] < -40) rate.ci99[l] = 2 * rate.value[l];
  const InertialCurve curve = inertial_curve(run.profiles, "mu");
  EXPECT_EQ(curve.I.size(), 38u);  // -39.5 ... -2.5
  EXPECT_TRUE(std::is_sorted(curve.I.begin(), curve.I.end()));
}

}  // namespace
}  // namespace drumlin
