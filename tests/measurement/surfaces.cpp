// Angles of surfaces that are known: of the grains in a drum, and of heaps.
#include <gtest/gtest.h>

#include <cmath>

#include "particles/measurement/history/surface_history.hpp"
#include "tests/measurement/packings.hpp"

namespace drumlin::surfaces {
using namespace particles;
namespace {

constexpr double degrees = 180 / std::numbers::pi;

/// Every grain touches something.
Snapshot resting(Snapshot s) {
  s.contacts.clear();
  for (std::size_t i = 0; i < s.x.size(); ++i)
    s.contacts.push_back({static_cast<std::int32_t>(i), -1, 0, 1, 1, 0});
  return s;
}

/// A heap of a square lattice under lines that fall from (0, height) at these angles, on a floor.
Snapshot heap(double height, double left_deg, double right_deg) {
  Snapshot s;
  const double spacing = 0.9;
  for (int row = 0; row * spacing < height; ++row)
    for (int column = -200; column <= 200; ++column) {
      const double x = column * spacing, z = (row + 0.5) * spacing;
      const double fall = std::abs(x) * std::tan((x < 0 ? left_deg : right_deg) / degrees);
      if (z <= height - fall) testing::add_grain(s, x, z, 0.45);
    }
  return resting(s);
}

TEST(SurfaceHistory, OfADrumHasTheSlopeOfTheGrainsInIt) {
  for (const double slope : {-27.0, 0.0, 12.0, 35.0}) {
    const Snapshot drum = resting(testing::filled_drum(30, 3, slope / degrees, 0.02));
    const SurfaceState state = surface_state(drum);
    EXPECT_NEAR(state.angle * degrees, slope, 0.05);
    EXPECT_NEAR(state.mass_angle * degrees, slope, 0.5);  // the lattice's last row at the wall
    EXPECT_TRUE(std::isnan(state.repose));
  }
}

TEST(SurfaceHistory, GrainsInFlightAreNoSurface) {
  Snapshot drum = resting(testing::filled_drum(30, 3, 0.4, 0.02));
  for (int i = 0; i < 12; ++i) testing::add_grain(drum, 3 - i, -2 + 5 + i % 3, 0.5);
  EXPECT_NEAR(surface_state(drum).angle, 0.4, 1e-3);
  // Nobody said what touches: a few of them do not count all the same.
  Snapshot unknown = testing::filled_drum(30, 3, 0.4, 0.02);
  for (int i = 0; i < 3; ++i) testing::add_grain(unknown, 3 - 2 * i, -2 + 5 + i, 0.5);
  unknown.contacts_known = false;
  EXPECT_NEAR(surface_state(unknown).angle, 0.4, 5e-3);
}

TEST(SurfaceHistory, GravityTellsWhatIsLevel) {
  const double slope = 0.35;
  for (const double turn : {0.3, -1.2}) {
    const Snapshot drum = testing::turned(resting(testing::filled_drum(30, 3, slope, 0.02)), turn);
    EXPECT_NEAR(surface_state(drum).angle, slope, 1e-3);
    EXPECT_NEAR(surface_state(testing::turned(heap(30, 26, 22), turn)).repose * degrees, 24, 1);
  }
}

TEST(SurfaceHistory, AHeapHasTheAnglesOfItsFlanks) {
  const SurfaceState even = surface_state(heap(30, 24, 24));
  EXPECT_NEAR(even.left * degrees, 24, 0.5);
  EXPECT_NEAR(even.right * degrees, 24, 0.5);
  EXPECT_NEAR(even.angle * degrees, 0, 0.5);
  const SurfaceState uneven = surface_state(heap(30, 31, 19));
  EXPECT_NEAR(uneven.left * degrees, 31, 0.5);
  EXPECT_NEAR(uneven.right * degrees, 19, 0.5);
  EXPECT_NEAR(uneven.repose * degrees, 25, 0.5);
}

TEST(SurfaceHistory, AHeapAtAWallHasOneFlank) {
  Snapshot half = heap(30, 89, 25);
  const SurfaceState state = surface_state(half);
  EXPECT_TRUE(std::isnan(state.left));
  EXPECT_NEAR(state.right * degrees, 25, 0.5);
  EXPECT_EQ(state.repose, state.right);
  for (double& x : half.x) x = -x;
  EXPECT_EQ(surface_state(half).repose, surface_state(half).left);
}

TEST(SurfaceHistory, GrainsAroundAHeapAndLargeOnesDoNotMoveIt) {
  Snapshot s = heap(30, 24, 24);
  for (int i = 0; i < 40; ++i) testing::add_grain(s, 75 + 3 * i, 0.45, 0.45);
  testing::add_grain(s, -30, 16, 2.5);
  EXPECT_NEAR(surface_state(resting(s)).repose * degrees, 24, 0.6);
}

TEST(SurfaceHistory, WhereThereIsNoneNothingIsSaid) {
  EXPECT_TRUE(std::isnan(surface_state(resting(testing::hexagonal_layer(40, 12))).angle));  // periodic
  Snapshot bed = resting(testing::hexagonal_layer(40, 12));
  bed.period_x = 0;
  EXPECT_NEAR(surface_state(bed).angle, 0, 5e-3);  // every other row ends half a disc further on
  EXPECT_TRUE(std::isnan(surface_state(bed).repose));
  Snapshot weightless = heap(30, 24, 24);
  weightless.gravity_z = 0;
  EXPECT_TRUE(std::isnan(surface_state(weightless).repose));
  EXPECT_TRUE(std::isnan(surface_state(testing::filled_drum(30, 3, 0.3, 0)).angle));  // nothing touches
  Snapshot few = heap(3, 30, 30);
  EXPECT_TRUE(std::isnan(surface_state(few).repose));
  EXPECT_TRUE(std::isnan(surface_state(Snapshot{}).angle));
}

}  // namespace
}  // namespace drumlin::surfaces
