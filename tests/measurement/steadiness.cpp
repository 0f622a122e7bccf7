// Unsteady and short runs are called so.
#include "particles/measurement/steadiness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace drumlin {
using namespace particles;
namespace {

constexpr double rotation = 0.01;
constexpr double turn = 2 * std::numbers::pi / rotation;

/// 400 snapshots of one turn after one turn; energy and slope flicker a little.
TimeSeries one_turn(double energy_growth, double slope_growth) {
  TimeSeries series;
  for (int s = 1; s <= 400; ++s) {
    const double share = s / 400.0;
    series.time.push_back(turn * (1 + share));
    series.wall_angle.push_back(2 * std::numbers::pi * (1 + share));
    series.kinetic_energy.push_back(1000 * (1 + energy_growth * share) + 30 * std::sin(0.9 * s));
    series.mass_angle.push_back(0.35 + slope_growth * share + 0.002 * std::cos(1.3 * s));
  }
  return series;
}

TEST(Steadiness, OneTurnAfterOneTurnIsSteady) {
  const Steadiness result = steadiness(one_turn(0, 0), rotation, 20);
  EXPECT_TRUE(result.steady) << result.reasons.front();
  EXPECT_NEAR(result.turns, 1, 1e-9);
  EXPECT_NEAR(result.turns_before, 1.0025, 1e-9);
  EXPECT_LT(std::abs(result.energy.value), result.energy.ci99 + 0.01);
}

TEST(Steadiness, EnergyThatGrowsIsNamed) {
  const Steadiness result = steadiness(one_turn(0.6, 0), rotation, 20);
  ASSERT_EQ(result.reasons.size(), 1u);
  EXPECT_NE(result.reasons[0].find("kinetic energy"), std::string::npos);
  EXPECT_NEAR(result.energy.value, 0.3 / 1.3, 0.01);  // halves lie 0.3 apart, about a mean of 1.3
}

TEST(Steadiness, SlopeThatCreepsIsNamed) {
  const Steadiness result = steadiness(one_turn(0, 0.05), rotation, 20);
  ASSERT_EQ(result.reasons.size(), 1u);
  EXPECT_NE(result.reasons[0].find("slope"), std::string::npos);
  EXPECT_NEAR(result.slope_deg.value, 0.025 * 180 / std::numbers::pi, 0.02);
}

TEST(Steadiness, HalfATurnIsShort) {
  TimeSeries series = one_turn(0, 0);
  for (auto* values : {&series.time, &series.wall_angle, &series.kinetic_energy, &series.mass_angle})
    values->resize(200);
  const Steadiness result = steadiness(series, rotation, 20);
  ASSERT_FALSE(result.steady);
  EXPECT_NE(result.reasons[0].find("0.50 turns"), std::string::npos) << result.reasons[0];
}

TEST(Steadiness, TooLittleBeforeTheFirstSnapshotIsSaid) {
  TimeSeries series = one_turn(0, 0);
  for (double& angle : series.wall_angle) angle -= std::numbers::pi;
  const Steadiness result = steadiness(series, rotation, 20);
  ASSERT_EQ(result.reasons.size(), 1u);
  EXPECT_NE(result.reasons[0].find("before"), std::string::npos);
}

TEST(Steadiness, FluctuationsThatHideAnyChangeAreSaid) {
  TimeSeries series = one_turn(0, 0);
  for (std::size_t s = 0; s < series.time.size(); ++s)
    series.kinetic_energy[s] = 1000 * (1 + 0.9 * std::sin(0.1 * static_cast<double>(s)));
  EXPECT_FALSE(steadiness(series, rotation, 20).steady);
}

}  // namespace
}  // namespace drumlin
