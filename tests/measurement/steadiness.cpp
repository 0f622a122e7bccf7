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

/// Slow shear between plates: a few grains jump, so that the energy is 0.01 mostly and 1 now and then;
/// pressure, stress and shear rate scatter by some percent about their means. `growth`: of the three over the
/// whole time.
TimeSeries slow_shear(double growth) {
  TimeSeries series;
  for (int s = 0; s < 400; ++s) {
    const double flicker = std::sin(0.9 * s) + std::sin(0.37 * s), factor = 1 + growth * s / 400.0;
    series.time.push_back(s);
    series.wall_angle.push_back(0);
    series.kinetic_energy.push_back((s * s) % 97 < 6 ? 1.0 + (s * 7) % 13 : 0.01);
    series.pressure.push_back(5 * factor * (1 + 0.03 * flicker));
    series.shear_stress.push_back(1.5 * factor * (1 + 0.05 * flicker));
    series.shear_rate.push_back(1e-3 * (1 + 0.05 * flicker));
  }
  return series;
}

/// Half a turn of a series, and one that begins after half a turn.
TimeSeries half_of(TimeSeries series) {
  for (auto* values : {&series.time, &series.wall_angle, &series.kinetic_energy, &series.mass_angle})
    values->resize(200);
  return series;
}
TimeSeries begun_early(TimeSeries series) {
  for (double& angle : series.wall_angle) angle -= std::numbers::pi;
  return series;
}
TimeSeries without_contacts(TimeSeries series) {
  for (auto* values : {&series.pressure, &series.shear_stress, &series.shear_rate})
    values->assign(values->size(), std::nan(""));
  return series;
}

TEST(Steadiness, EachReasonAgainstItIsNamed) {
  struct Judged {
    TimeSeries series;
    double rotation;
    std::vector<std::string> reasons;  ///< words of each
  };
  const std::vector<Judged> all{{one_turn(0, 0), rotation, {}},
                                {one_turn(0.6, 0), rotation, {"kinetic energy"}},
                                {one_turn(0, 0.05), rotation, {"slope"}},
                                {half_of(one_turn(0, 0)), rotation, {"0.50 turns"}},
                                {begun_early(one_turn(0, 0)), rotation, {"before"}},
                                {slow_shear(0), 0, {}},
                                {slow_shear(0.5), 0, {"pressure", "shear stress"}},
                                {without_contacts(slow_shear(0)), 0, {"too much to tell"}}};
  for (const Judged& one : all) {
    const Steadiness result = steadiness(one.series, one.rotation, 20);
    EXPECT_EQ(result.steady, one.reasons.empty());
    ASSERT_EQ(result.reasons.size(), one.reasons.size());
    for (std::size_t r = 0; r < one.reasons.size(); ++r)
      EXPECT_NE(result.reasons[r].find(one.reasons[r]), std::string::npos) << result.reasons[r];
  }
}

TEST(Steadiness, ChangesAreThoseBetweenTheHalves) {
  const Steadiness steady = steadiness(one_turn(0, 0), rotation, 20);
  EXPECT_NEAR(steady.turns, 1, 1e-9);
  EXPECT_NEAR(steady.turns_before, 1.0025, 1e-9);
  EXPECT_LT(std::abs(steady.energy.value), steady.energy.ci99 + 0.01);
  // Halves lie half of the growth apart, about the mean.
  EXPECT_NEAR(steadiness(one_turn(0.6, 0), rotation, 20).energy.value, 0.3 / 1.3, 0.01);
  EXPECT_NEAR(steadiness(one_turn(0, 0.05), rotation, 20).slope_deg.value, 0.025 * 180 / std::numbers::pi,
              0.02);
  EXPECT_NEAR(steadiness(slow_shear(0.5), 0, 20).pressure.value, 0.25 / 1.25, 0.01);
}

TEST(Steadiness, SlowShearIsJudgedByItsStressAndNotByTheGrainsThatJump) {
  const Steadiness result = steadiness(slow_shear(0), 0, 20);
  EXPECT_GT(result.energy.ci99, 0.5);  // the energy alone tells nothing
  EXPECT_EQ(result.judged_by, "stress and shear rate");
}

/// Haff's law: E = E0/(1 + t/tau)^2, with collisions now and then in place of a stress.
TimeSeries cooling_gas(double tau) {
  TimeSeries series;
  for (int s = 0; s < 400; ++s) {
    series.time.push_back(s);
    series.wall_angle.push_back(0);
    series.kinetic_energy.push_back(100 / std::pow(1 + s / tau, 2));
    series.pressure.push_back(s % 3 == 0 ? series.kinetic_energy.back() : 0);
    series.shear_stress.push_back(s % 2 == 0 ? 1 : -1);
    series.shear_rate.push_back(s % 4 < 2 ? 1 : -1);
  }
  return series;
}

TEST(Steadiness, CoolingGasDecaysHoweverFast) {
  for (const double tau : {2.0, 20.0, 200.0, 2000.0}) {
    const Steadiness result = steadiness(cooling_gas(tau), 0, 20);
    EXPECT_FALSE(result.steady) << tau;
    // Between the middles of the first and the last block; a straight line of the logarithm follows the
    // hyperbola to a quarter when it decays over two decades.
    const double decay = 2 * std::log((1 + 390 / tau) / (1 + 10 / tau));
    EXPECT_NEAR(result.energy_trend.value, -decay, 0.3 * decay) << tau;
  }
}

TEST(Steadiness, DriftInsideTheHalvesDoesNotHideItself) {
  // A loss of 30 % in all: the halves lie 15 % of the mean apart, and each has a range as large as that.
  TimeSeries series = cooling_gas(400 / (1 / std::sqrt(0.7) - 1));
  for (std::size_t s = 0; s < series.time.size(); ++s)
    series.kinetic_energy[s] *= 1 + 0.02 * std::sin(0.9 * static_cast<double>(s));
  const Steadiness result = steadiness(series, 0, 20);
  EXPECT_FALSE(result.steady);
  EXPECT_NEAR(std::exp(result.energy_trend.value), 0.7, 0.02);
}

TEST(Trend, OfAStraightLineIsItsRiseAndOfNoiseIsWithinItsInterval) {
  std::vector<double> rising, flat;
  for (int b = 0; b < 20; ++b) {
    rising.push_back(3 * (b + 0.5) / 20);
    flat.push_back(std::sin(2.4 * b));
  }
  EXPECT_NEAR(trend_over(rising).value, 3, 1e-12);
  EXPECT_LT(trend_over(rising).ci99, 1e-6);
  EXPECT_LT(std::abs(trend_over(flat).value), trend_over(flat).ci99);
  EXPECT_TRUE(std::isnan(trend_over(std::vector<double>{1, 2, 3}).value));
}

}  // namespace
}  // namespace drumlin
