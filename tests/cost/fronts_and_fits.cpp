// Fronts of work-precision diagrams, errors of settings, differences of motions.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "coupling/accuracy/pareto.hpp"
#include "coupling/accuracy/setting_error.hpp"
#include "particles/measurement/motion_difference.hpp"

namespace drumlin {
namespace {

TEST(ParetoFront, HoldsWhatNoOtherPointBeats) {
  const std::vector<double> cost = {1, 2, 3, 4, 2.5}, error = {8, 4, 5, 1, 4};
  EXPECT_EQ(pareto_front(cost, error), (std::vector<bool>{true, true, false, true, false}));
}

TEST(ParetoFront, KeepsBothOfTwoThatAreAlikeAndNoneThatIsNotKnown) {
  const std::vector<double> cost = {1, 1, 0.5, NAN}, error = {2, 2, NAN, 0};
  EXPECT_EQ(pareto_front(cost, error), (std::vector<bool>{true, true, false, false}));
}

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

TEST(SettingError, IsNotSignificantWhereTheIntervalsHideIt) {
  const std::vector<SettingPoint> points = {{1, 10.1, 1}, {2, 9.8, 1}, {4, 10.2, 1}};
  const auto found = setting_error(points, 2, both);
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->significant());
  EXPECT_GT(found->ci99, 0.5);  // about that of a point, as long as the lever is no longer than the distance
}

TEST(SettingError, NeedsThreeSettings) {
  EXPECT_FALSE(setting_error(std::vector<SettingPoint>{{1, 1, 0}, {2, 3, 0}, {2, 3.1, 0}}, 1, both));
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
