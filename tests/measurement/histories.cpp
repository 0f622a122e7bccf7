// Histories: stress, fabric and strain of a region, and tractions of walls, of snapshots whose answers are
// known.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "coupling/core/basics/errors.hpp"
#include "particles/measurement/history/region_history.hpp"
#include "particles/measurement/history/wall_history.hpp"

namespace drumlin::particles {
namespace {

constexpr double pi = std::numbers::pi;

Snapshot lattice(int columns, int rows) {
  Snapshot s;
  s.time_step = 0.5;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) {
      s.x.push_back(i + 0.5);
      s.z.push_back(j + 0.5);
      s.v_x.push_back(0);
      s.v_z.push_back(0);
      s.radius.push_back(0.5);
    }
  return s;
}

Snapshot moved_by(Snapshot s, const PlaneMatrix& F, double time) {
  for (std::size_t i = 0; i < s.x.size(); ++i) {
    const double x = s.x[i], z = s.z[i];
    s.x[i] = F.xx * x + F.xz * z;
    s.z[i] = F.zx * x + F.zz * z;
  }
  s.time += time;
  return s;
}

TEST(RegionHistory, ARigidTurnIsNoStrain) {
  const Snapshot before = lattice(20, 20);
  const double angle = 0.3;
  const Snapshot now =
      moved_by(before, {std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle)}, 2);
  const auto G = mean_gradient({5, 15, 2, 10}, before, now);
  ASSERT_TRUE(G);
  EXPECT_NEAR(G->xx, 0, 1e-14);
  EXPECT_NEAR(G->zz, 0, 1e-14);
  EXPECT_NEAR(G->xz + G->zx, 0, 1e-14);
  EXPECT_NEAR(G->xz, 2 * std::tan(angle / 2) / 2, 1e-14);
}

TEST(RegionHistory, AddsTheStrainOfSimpleShearAcrossAPeriod) {
  Snapshot s = lattice(20, 10);
  s.period_x = 20;
  RegionHistory history({0, 20, 2, 8});
  history.add(s);
  for (int k = 0; k < 30; ++k) {  // each grain ends 30 * 0.1 * z to the right, not wrapped back
    s = moved_by(s, {1, 0.1, 0, 1}, 1);
    const RegionState& state = history.add(s);
    EXPECT_NEAR(state.gradient.xz, 0.1, 1e-13);
    EXPECT_NEAR(state.gradient.xx, 0, 1e-13);
    EXPECT_NEAR(state.strain, 0.1 * (k + 1), 1e-12);
  }
}

TEST(RegionHistory, ABoxWiderThanThePeriodIsRefused) {
  Snapshot s = lattice(20, 10);
  s.period_x = 20;
  EXPECT_THROW(RegionHistory({0, 21, 2, 8}).add(s), InputError);
  EXPECT_NO_THROW(RegionHistory({5, 25, 2, 8}).add(s));
}

TEST(RegionHistory, PutsTheWholeStressOfAChainIntoTheBox) {
  Snapshot s = lattice(1, 10);
  s.gravity_z = 0;
  const double force = 3, friction = 1;
  for (std::int32_t i = 1; i < 10; ++i)
    s.contacts.push_back({i, i - 1, 0, 1, force * s.time_step, friction * s.time_step});
  // One column, 1 d wide; the box ends in the middle of branches.
  const RegionState state = RegionHistory({0, 1, 2.25, 7.75}).add(s);
  EXPECT_NEAR(state.pressure.zz, force, 1e-14);
  EXPECT_NEAR(state.pressure.xz, friction, 1e-14);  // tangent of a normal (0, 1) is (1, 0)
  EXPECT_NEAR(state.pressure.xx, 0, 1e-14);
  EXPECT_EQ(state.grains, 6u);
  EXPECT_NEAR(state.nu, 6 * pi / 4 / 5.5, 1e-14);
  EXPECT_NEAR(state.coordination, 2, 1e-14);
  EXPECT_NEAR(state.fabric.zz, 1, 1e-14);
  EXPECT_TRUE(std::isnan(state.gradient.xx));
}

TEST(RegionHistory, OfScatteredGrainsThereIsTheKineticStressAlone) {
  Snapshot s = lattice(10, 10);
  for (std::size_t i = 0; i < s.x.size(); ++i) s.v_x[i] = i % 2 ? 1 : -1;
  const RegionState state = RegionHistory({0, 10, 0, 10}).add(s);
  EXPECT_NEAR(state.pressure.xx, pi / 4, 1e-14);
  EXPECT_NEAR(state.kinetic.xx, pi / 4, 1e-14);
  EXPECT_NEAR(state.pressure.zz, 0, 1e-14);
  EXPECT_EQ(state.coordination, 0);
  EXPECT_TRUE(std::isnan(state.fabric.xx));
  s.contacts_known = false;
  EXPECT_TRUE(std::isnan(RegionHistory({0, 10, 0, 10}).add(s).pressure.xx));
}

TEST(RegionHistory, SharesOfALine) {
  const Rectangle box{0, 1, 0, 1};
  EXPECT_NEAR(share_inside(box, -1, 0.5, 2, 0), 0.5, 1e-15);
  EXPECT_NEAR(share_inside(box, 0.25, 0.25, 0.5, 0.5), 1, 1e-15);
  EXPECT_NEAR(share_inside(box, -1, -1, 3, 3), 1.0 / 3, 1e-15);
  EXPECT_EQ(share_inside(box, 2, 0.5, 0, 1), 0);
  EXPECT_EQ(share_inside(box, 2, 2, 1, 1), 0);
}

// One grain at the lowest point of a drum and one at the right (90 degrees anticlockwise from it).
TEST(WallHistory, TellsTractionsOfSectorsAndTheTorque) {
  Snapshot s;
  s.time_step = 0.25;
  s.x = {0, 9.5};
  s.z = {-9.5, 0};
  s.radius = {0.5, 0.5};
  s.v_x = s.v_z = {0, 0};
  const double force = 2, drag = 1;
  // The wall drags clockwise: to the left at the lowest point, downwards at the right. The tangents (n_z,
  // -n_x) of normals towards the centre are (1, 0) and (0, 1).
  s.contacts = {{0, -1, 0, 1, force * s.time_step, -drag * s.time_step},
                {1, -1, -1, 0, 3 * force * s.time_step, -3 * drag * s.time_step}};
  const std::vector<int> wall_of_shape{0};
  const std::vector<Shape> shapes{Container{{0, 0}, 10}};
  const auto states = wall_states(s, 1, wall_of_shape, shapes, 5);  // 72 degrees each, the third about below
  ASSERT_EQ(states.size(), 1u);
  const WallState& wall = states[0];
  EXPECT_NEAR(wall.force_x, drag + 3 * force, 1e-14);
  EXPECT_NEAR(wall.force_z, -force + 3 * drag, 1e-14);
  EXPECT_NEAR(wall.torque, -40 * drag, 1e-13);
  ASSERT_EQ(wall.sectors.size(), 5u);
  const double length = 2 * pi * 10 / 5;
  EXPECT_NEAR(wall.sectors[2].from, -36 * pi / 180, 1e-14);
  EXPECT_NEAR(wall.sectors[2].normal, force / length, 1e-14);
  EXPECT_NEAR(wall.sectors[2].shear, drag / length, 1e-14);
  EXPECT_NEAR(wall.sectors[3].normal, 3 * force / length, 1e-14);
  EXPECT_NEAR(wall.sectors[3].shear, 3 * drag / length, 1e-14);
  EXPECT_EQ(wall.sectors[4].normal, 0);
}

TEST(WallHistory, AStraightWallHasForcesAlone) {
  Snapshot s = lattice(1, 1);
  s.contacts = {{0, -2, 0, 1, 5 * s.time_step, 0}};
  const std::vector<int> wall_of_shape{0, 1};
  const std::vector<Shape> shapes{Segment{{0, 9}, {1, 9}}, Segment{{0, 0}, {1, 0}}};
  const auto states = wall_states(s, 2, wall_of_shape, shapes, 4);
  EXPECT_EQ(states[0].force_z, 0);
  EXPECT_EQ(states[1].force_z, -5);
  EXPECT_TRUE(states[1].sectors.empty());
  EXPECT_TRUE(std::isnan(states[1].torque));
}

}  // namespace
}  // namespace drumlin::particles
