// Closed forms that a single grain, or a few, must follow (particles.md of the literature: impact, sliding,
// rolling).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scenes.hpp"

namespace drumlin {
using namespace particles;
namespace {

using test::add_stage;
using test::floor_wall;
using test::Grain;
using test::scene_of;
using test::TemporaryFolder;

Bodies after_stages(const Scene& scene) {
  Simulation simulation(scene);
  while (!simulation.finished()) (void)simulation.step();
  return simulation.state().bodies;
}

TEST(Drop, PeaksFallByTheSquareOfRestitution) {
  const TemporaryFolder folder;
  const double e = 0.6, height = 4, h = 2e-4;
  Scene scene = scene_of({{0, 0.5 + height}}, folder);
  scene.walls = {floor_wall()};
  scene.effects.gravity = Gravity{};
  scene.effects.restitution = Restitution{e, e};
  add_stage(scene, 14, h);
  Simulation simulation(scene);
  std::vector<double> peaks;
  double before = height, now = height;
  while (!simulation.finished()) {
    (void)simulation.step();
    const double z = simulation.state().bodies.z[0] - 0.5;
    if (now > before && now > z) peaks.push_back(now);
    before = now, now = z;
  }
  ASSERT_GE(peaks.size(), 4u);
  // First order in the step: an impact is late by up to h, at a speed of sqrt(2 height) = 2.8.
  for (int n = 0; n < 4; ++n)
    EXPECT_NEAR(peaks[n], height * std::pow(e, 2 * (n + 1)), 5 * h * std::sqrt(2 * height)) << n;
}

TEST(Drop, ComesToRestWhenItMustAndStaysThere) {
  const TemporaryFolder folder;
  const double e = 0.5, height = 2, h = 2e-4;
  Scene scene = scene_of({{0, 0.5 + height}}, folder);
  scene.walls = {floor_wall()};
  scene.effects.gravity = Gravity{};
  scene.effects.restitution = Restitution{e, e};
  const double rest = std::sqrt(2 * height) * (1 + e) / (1 - e);
  add_stage(scene, rest * 1.02 + 1, h);
  Simulation simulation(scene);
  double jitter = 0;
  while (!simulation.finished()) {
    (void)simulation.step();
    if (simulation.state().time() > rest * 1.02)
      jitter = std::max(jitter, std::abs(simulation.state().bodies.v_z[0]));
  }
  EXPECT_LT(jitter, 2 * h);
  EXPECT_NEAR(simulation.state().bodies.z[0], 0.5, 1e-6);
}

/// A disc that meets a wall without gravity; returns its velocities afterwards.
Bodies oblique_impact(double v_t, double v_n, double mu, double e) {
  const TemporaryFolder folder;
  Scene scene = scene_of({{0, 0.55, 1, v_t, -v_n, 0}}, folder);
  scene.walls = {floor_wall()};
  scene.effects.friction = Friction{mu, mu};
  scene.effects.restitution = Restitution{e, e};
  scene.effects.spin = Spin{};
  add_stage(scene, 0.2, 1e-3);
  return after_stages(scene);
}

TEST(ObliqueImpact, SlowTangentSticksAndKeepsTwoThirds) {
  const double e = 0.5, mu = 0.3, v_n = 1, v_t = 0.9 * 3 * mu * (1 + e) * v_n;
  const Bodies after = oblique_impact(v_t, v_n, mu, e);
  EXPECT_NEAR(after.v_z[0], e * v_n, 1e-9);
  EXPECT_NEAR(after.v_x[0], 2.0 / 3 * v_t, 1e-8);
  EXPECT_NEAR(after.v_x[0], 0.5 * after.spin[0], 1e-8);  // rolls: rim at rest on the wall
}

TEST(ObliqueImpact, FastTangentSlips) {
  const double e = 0.5, mu = 0.3, v_n = 1, v_t = 1.5 * 3 * mu * (1 + e) * v_n;
  const Bodies after = oblique_impact(v_t, v_n, mu, e);
  EXPECT_NEAR(after.v_z[0], e * v_n, 1e-9);
  EXPECT_NEAR(after.v_x[0], v_t - mu * (1 + e) * v_n, 1e-8);
}

TEST(SlideToRoll, EndsAtTwoThirdsOfTheSpeed) {
  const TemporaryFolder folder;
  const double mu = 0.2, v0 = 1.5, h = 1e-3;
  Scene scene = scene_of({{0, 0.5, 1, v0}}, folder);
  scene.walls = {floor_wall()};
  scene.effects.gravity = Gravity{};
  scene.effects.friction = Friction{mu, mu};
  scene.effects.spin = Spin{};
  add_stage(scene, 4, h);
  Simulation simulation(scene);
  double rolls_at = 0;
  while (!simulation.finished()) {
    (void)simulation.step();
    const Bodies& b = simulation.state().bodies;
    if (rolls_at == 0 && std::abs(b.v_x[0] - 0.5 * b.spin[0]) < 1e-9) rolls_at = simulation.state().time();
  }
  EXPECT_NEAR(rolls_at, v0 / (3 * mu), 2 * h);
  EXPECT_NEAR(simulation.state().bodies.v_x[0], 2.0 / 3 * v0, 1e-9);
}

TEST(SlideWithoutSpin, StopsAfterItsEnergyIsSpent) {
  // A disc that cannot turn slides like a block: it stops at t = v0 / (mu g).
  const TemporaryFolder folder;
  const double mu = 0.25, v0 = 0.5, h = 1e-3;
  Scene scene = scene_of({{0, 0.5, 1, v0}}, folder);
  scene.walls = {floor_wall()};
  scene.effects.gravity = Gravity{};
  scene.effects.friction = Friction{mu, mu};
  add_stage(scene, 3, h);
  Simulation simulation(scene);
  while (!simulation.finished()) {
    (void)simulation.step();
    const double t = simulation.state().time();
    ASSERT_NEAR(simulation.state().bodies.v_x[0], std::max(0.0, v0 - mu * t), 1e-9) << t;
  }
}

/// Acceleration of a disc on a floor in gravity tilted by `slope_deg`.
double acceleration_on_incline(double slope_deg, double mu) {
  const TemporaryFolder folder;
  Scene scene = scene_of({{0, 0.5}}, folder);
  scene.walls = {floor_wall()};
  scene.effects.gravity = Gravity{9.81, -90 + slope_deg};
  scene.effects.friction = Friction{mu, mu};
  scene.effects.spin = Spin{};
  add_stage(scene, 2, 1e-3);
  return after_stages(scene).v_x[0] / 2;
}

TEST(Incline, RollsBelowThreeTimesTheFriction) {
  EXPECT_NEAR(acceleration_on_incline(20, 0.2), 2.0 / 3 * std::sin(std::numbers::pi / 9),
              1e-8);  // tan 20 = 0.364 < 0.6
}

TEST(Incline, SlipsAboveThreeTimesTheFriction) {
  const double slope = std::numbers::pi / 9;
  EXPECT_NEAR(acceleration_on_incline(20, 0.1), std::sin(slope) - 0.1 * std::cos(slope),
              1e-8);  // 0.364 > 0.3
}

TEST(Column, ContactKCarriesTheWeightAbove) {
  const TemporaryFolder folder;
  std::vector<Grain> grains;
  for (int k = 0; k < 30; ++k) grains.push_back({0, 0.5 + k});
  Scene scene = scene_of(grains, folder);
  scene.walls = {floor_wall()};
  scene.effects.gravity = Gravity{};
  scene.effects.friction = Friction{0.4, 0.4};
  scene.effects.spin = Spin{};
  scene.solver.max_sweeps = 20000;
  const double h = 0.05;
  add_stage(scene, 1, h);
  Simulation simulation(scene);
  while (!simulation.finished()) (void)simulation.step();
  const Snapshot snapshot = simulation.take_snapshot();
  ASSERT_EQ(snapshot.contacts.size(), 30u);
  const double weight = mass_of_disc(0.5);
  for (const auto& c : snapshot.contacts) {
    const double above = c.j < 0 ? 30 : 30 - std::max(c.i, c.j);
    EXPECT_NEAR(c.impulse_n / h, above * weight, 1e-5 * 30 * weight);
    EXPECT_NEAR(c.impulse_t, 0, 1e-9);
  }
}

TEST(TouchingCradle, OneBallOnTwoFollowsNewtonsLaw) {
  // Simultaneous contacts, Newton's law: striker (1 - 2e)/3, the others (1 + e)/3 of the speed; from the
  // first ball's contact, which alone has an approach speed.
  const TemporaryFolder folder;
  const double e = 0.4;
  Scene scene = scene_of({{-1.02, 0, 1, 1}, {0, 0}, {1, 0}}, folder);
  scene.effects.restitution = Restitution{e, e};
  add_stage(scene, 0.1, 1e-3);
  const Bodies after = after_stages(scene);
  EXPECT_NEAR(after.v_x[0], (1 - 2 * e) / 3, 1e-8);
  EXPECT_NEAR(after.v_x[1], (1 + e) / 3, 1e-8);
  EXPECT_NEAR(after.v_x[2], (1 + e) / 3, 1e-8);
}

TEST(Billiard, TenThousandImpactsKeepTheEnergy) {
  const TemporaryFolder folder;
  Scene scene = scene_of({{0.3, 0, 1, 1}}, folder);
  scene.walls = {{"left", SegmentShape{{-2, -5}, {-2, 5}}}, {"right", SegmentShape{{2, -5}, {2, 5}}}};
  scene.effects.restitution = Restitution{1, 1};
  scene.solver.tolerance = 1e-14;
  scene.solver.check_every = 1;
  add_stage(scene, 30500, 0.1);
  Simulation simulation(scene);
  const double before = kinetic_energy(simulation.state().bodies);
  double velocity = 1;
  int impacts = 0;
  while (!simulation.finished()) {
    (void)simulation.step();
    const double now = simulation.state().bodies.v_x[0];
    impacts += now * velocity < 0;
    velocity = now;
  }
  EXPECT_GE(impacts, 10000);
  EXPECT_NEAR(kinetic_energy(simulation.state().bodies) / before, 1, 1e-12);
}

TEST(Shot, DiscAtAHundredTimesTheGrainSpeedDoesNotPassAThinWall) {
  const TemporaryFolder folder;
  Scene scene = scene_of({{0, 30, 1, 10, -100}}, folder);
  scene.walls = {floor_wall()};
  scene.effects.restitution = Restitution{0.5, 0.5};
  add_stage(scene, 1, 0.0545);
  Simulation simulation(scene);
  while (!simulation.finished()) {
    (void)simulation.step();
    ASSERT_GT(simulation.state().bodies.z[0], 0.5 - 1e-6);
  }
  EXPECT_NEAR(simulation.state().bodies.v_z[0], 50, 1e-6);
}

TEST(RotatingContainer, GrainOnTheWallTurnsWithItAndDoesNotDrift) {
  const TemporaryFolder folder;
  const double turns = 10, spin = 0.5;  // centripetal acceleration presses it to the wall
  Scene scene = scene_of({{0, -9.5, 1, -9.5 * spin, 0, spin}}, folder);
  scene.walls = {{"drum", ContainerShape{{0, 0}, 10}}};
  scene.effects.friction = Friction{0.9, 0.9};
  scene.effects.spin = Spin{};
  add_stage(scene, turns * 2 * std::numbers::pi / spin, 0.05);
  const double time_s = std::sqrt(1e-3 / 9.81);
  scene.stages[0].motions = {{"drum", Rotation{spin / time_s * 60 / (2 * std::numbers::pi), {0, 0}}}};
  Simulation simulation(scene);
  double farthest = 0;
  while (!simulation.finished()) {
    (void)simulation.step();
    const Bodies& b = simulation.state().bodies;
    farthest = std::max(farthest, std::abs(std::hypot(b.x[0], b.z[0]) - 9.5));
  }
  EXPECT_LT(farthest, 2e-4);
  EXPECT_NEAR(std::hypot(simulation.state().bodies.v_x[0], simulation.state().bodies.v_z[0]), 9.5 * spin,
              0.01);
  EXPECT_NEAR(simulation.state().bodies.spin[0], spin, 0.01);
}

TEST(ThreeDiscs, OverAllGapsAnImpactGivesNoEnergy) {
  for (const double e : {0.0, 0.46, 0.7, 0.9, 1.0})
    for (int k = 0; k <= 40; ++k) {
      const TemporaryFolder folder;
      Scene scene = scene_of({{-1.02, 0, 1, 6}, {0, 0}, {1 + 0.02 * k, 0}}, folder);
      scene.effects.restitution = Restitution{e, e};
      add_stage(scene, 0.6, 0.0545);
      Simulation simulation(scene);
      double energy = kinetic_energy(simulation.state().bodies);
      const double first = energy;
      while (!simulation.finished()) (void)simulation.step();
      ASSERT_LE(kinetic_energy(simulation.state().bodies), first * (1 + 1e-9)) << e << ' ' << k;
    }
}

TEST(FastDisc, PushesItsTargetOntoTheNextNotThroughIt) {
  const TemporaryFolder folder;
  Scene scene = scene_of({{-1, 0, 1, 200}, {0, 0}, {1.5, 0}}, folder);
  add_stage(scene, 0.5, 0.05);
  Simulation simulation(scene);
  while (!simulation.finished()) {
    (void)simulation.step();
    const Bodies& b = simulation.state().bodies;
    ASSERT_LT(b.x[0] + 1, b.x[1] + 1e-3);
    ASSERT_LT(b.x[1] + 1, b.x[2] + 1e-3);
  }
}

TEST(FreeFall, IsExact) {
  const TemporaryFolder folder;
  Scene scene = scene_of({{0, 3}}, folder);
  scene.effects.gravity = Gravity{};
  add_stage(scene, 1, 0.02);
  EXPECT_NEAR(after_stages(scene).z[0], 2.5, 1e-12);
}

}  // namespace
}  // namespace drumlin
