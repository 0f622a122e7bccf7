// Errors of settings, differences of motions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "coupling/core/statistics/quantiles.hpp"
#include "coupling/core/statistics/setting_error.hpp"
#include "particles/measurement/motion_difference.hpp"

namespace drumlin {
using namespace statistics;
using namespace particles;
namespace {

const std::vector<double> both = {1, 0.5};

TEST(SettingError, ComesBackFromExactData) {
  for (const double power : {1.0, 0.5}) {
    std::vector<SettingPoint> points;
    for (const double h : {1e-3, 3e-3, 1e-2, 3e-2}) points.push_back({h, 7 - 5 * std::pow(h, power), 0});
    const auto found = setting_error(points, 3e-3, both);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->power, power);
    EXPECT_NEAR(found->error, -5 * std::pow(3e-3, power), 1e-12);
    EXPECT_EQ(found->smallest, 1e-3);  // 3e-2 is far away
  }
}

TEST(SettingError, NeedsThreeSettings) {
  EXPECT_FALSE(setting_error(std::vector<SettingPoint>{{1, 1, 0}, {2, 3, 0}, {2, 3.1, 0}}, 1, both));
}

// Values 1, 3, 2 at settings 1, 2, 3: slope 1/2, sum of squares about the line 3/2, one degree of freedom.
std::vector<SettingPoint> three_points(double ci99) { return {{1, 1, ci99}, {2, 3, ci99}, {3, 2, ci99}}; }

TEST(SettingError, OneDegreeOfFreedomAsksForStudentsT) {
  const double by_scatter = student_quantile_99(1) * std::sqrt(1.5 / 2);
  for (const double ci99 : {0.0, 0.1}) {  // no interval, or one that says less than the scatter
    const auto found = setting_error(three_points(ci99), 1, std::vector<double>{1});
    EXPECT_NEAR(found->error, 0.5, 1e-12);
    EXPECT_NEAR(found->ci99, by_scatter, 1e-9);
    EXPECT_FALSE(found->significant());
  }
  EXPECT_NEAR(setting_error(three_points(1000), 1, std::vector<double>{1})->ci99, 1000 / std::sqrt(2), 1e-9);
}

TEST(SettingError, IntervalCoversThePowersThatTheScatterLeavesOpen) {
  const auto one = setting_error(three_points(0), 1, std::vector<double>{1}),
             root = setting_error(three_points(0), 1, std::vector<double>{0.5}),
             found = setting_error(three_points(0), 1, both);
  EXPECT_GE(found->error + found->ci99, std::max(one->error + one->ci99, root->error + root->ci99) - 1e-9);
  EXPECT_LE(found->error - found->ci99, std::min(one->error - one->ci99, root->error - root->ci99) + 1e-9);
  // Nothing is left open by points that lie on one law.
  std::vector<SettingPoint> exact;
  for (const double h : {1.0, 2.0, 3.0}) exact.push_back({h, 7 - 5 * h, 0});
  EXPECT_NEAR(setting_error(exact, 1, both)->ci99, 0, 1e-9);
}

/// Share of noisy records of so many settings whose interval holds the error C at the setting 1.
double coverage(int settings, double C, double stated) {
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal;
  int inside = 0;
  constexpr int trials = 4000;
  for (int trial = 0; trial < trials; ++trial) {
    std::vector<SettingPoint> points;
    for (int i = 0; i < settings; ++i)
      points.push_back({1.0 + i, 7 + C * (1 + i) + normal(engine), stated * normal_quantile_99});
    const auto found = setting_error(points, 1, both);
    inside += std::abs(found->error - C) <= found->ci99;
  }
  return inside / double(trials);
}

TEST(SettingError, IntervalHoldsTheError) {
  // Intervals of the points: none, right, three times too small. Binomial error of 4000 trials 0.16 %.
  for (const int settings : {3, 4, 5})
    for (const double C : {0.0, 1.0})
      for (const double stated : {0.0, 1.0, 1.0 / 3})
        EXPECT_GT(coverage(settings, C, stated), 0.985) << settings << ' ' << C << ' ' << stated;
}

Bodies some_grains() {
  Bodies bodies;
  for (int i = 0; i < 40; ++i) add_body(bodies, i % 8, i / 8, 0.5);
  for (std::size_t b = 0; b < bodies.count(); ++b) bodies.v_x[b] = 0.1 * bodies.z[b];  // simple shear
  return bodies;
}

Bodies moved(Bodies bodies, double time, double speed, double spin) {
  for (std::size_t b = 0; b < bodies.count(); ++b) {
    const double x = bodies.x[b], z = bodies.z[b];
    bodies.v_x[b] += speed + spin * z, bodies.v_z[b] -= spin * x;
    bodies.x[b] += time * bodies.v_x[b], bodies.z[b] += time * bodies.v_z[b];
  }
  return bodies;
}

TEST(MotionDifference, OfTheSameMotionIsNought) {
  const Bodies start = some_grains(), end = moved(start, 0.1, 0, 0);
  const MotionDifference d = motion_difference(start, end, end);
  EXPECT_EQ(d.velocity, 0);
  EXPECT_EQ(d.displacement, 0);
  EXPECT_EQ(d.field, 0);
  EXPECT_EQ(d.energy, 0);
}

// What all grains share is no flow: the same difference counts the same in a frame that moves and turns.
TEST(MotionDifference, IsRelativeToTheMotionWithoutItsRigidPart) {
  const Bodies start = some_grains();
  const auto difference = [&](double speed, double spin) {
    const Bodies reference = moved(start, 0.1, speed, spin);
    Bodies other = reference;
    other.v_x[3] += 0.01, other.x[3] += 0.001;
    return motion_difference(start, reference, other);
  };
  const MotionDifference at_rest = difference(0, 0), carried = difference(3, 0.7);
  EXPECT_GT(at_rest.velocity, 0);
  EXPECT_NEAR(carried.velocity / at_rest.velocity, 1, 1e-9);
  EXPECT_NEAR(carried.displacement / at_rest.displacement, 1, 1e-9);
  EXPECT_NEAR(carried.field / at_rest.field, 1, 1e-9);
  EXPECT_LT(at_rest.field, at_rest.displacement);  // one grain of a square
}

}  // namespace
}  // namespace drumlin
