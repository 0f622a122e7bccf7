// The energy ledger: closed forms of single mechanisms, and books that close whatever acts.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scenes.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// The ledger at the end of a scene, where it closes to 1e-10 of the turnover; on the way, where hardly
/// anything may have happened yet, but for the rounding of the energy itself.
EnergyLedger ledger_of(Scene scene) {
  scene.output.energy_ledger = true;
  TestRun run(scene);
  run.each_step([&] {
    const EnergyLedger& ledger = *run.state().energy;
    const double rounding = 1e-14 * (ledger.kinetic + std::abs(ledger.potential));
    EXPECT_LE(std::abs(closing_error(ledger)), 1e-10 * ledger.turnover + rounding) << run.state().step;
  });
  const EnergyLedger& ledger = *run.state().energy;
  EXPECT_LE(std::abs(closing_error(ledger)), 1e-10 * ledger.turnover);
  return ledger;
}

TEST(EnergyLedger, FreeFallTradesPotentialForKineticEnergy) {
  const EnergyLedger ledger = ledger_of(scene_of({{0, 10}}).with(Gravity{}).lasting(1, 1e-2));
  EXPECT_NEAR(ledger.kinetic, weight / 2, 1e-12);
  EXPECT_NEAR(ledger.time_integration, 0, 1e-12);
  EXPECT_EQ(ledger.walls, 0);
  EXPECT_EQ(ledger.friction, 0);
  EXPECT_EQ(ledger.projection, 0);
}

TEST(EnergyLedger, ObliqueImpactSplitsIntoNormalAndTangentialLoss) {
  const double e = 0.5, mu = 0.3, v_n = 1, v_t = 1.5 * 3 * mu * (1 + e) * v_n;
  Scene scene = scene_of({{0, 0.55, 1, v_t, -v_n}})
                    .between({floor_wall()})
                    .with(Friction{mu, mu}, Restitution{e, e}, Spin{})
                    .lasting(0.2, 1e-3);
  const EnergyLedger ledger = ledger_of(scene);
  EXPECT_NEAR(ledger.impacts, -(1 - e * e) * weight * v_n * v_n / 2, 1e-9);
  // Slips all the way: impulse mu (1 + e) m v_n on the mean of the sliding speeds v_t and v_t - 3 impulse/m.
  const double impulse = mu * (1 + e) * v_n;
  EXPECT_NEAR(ledger.friction, -weight * impulse * (v_t - 1.5 * impulse), 1e-8);
}

TEST(EnergyLedger, ProjectionIsBookedAsPotentialEnergy) {
  Scene scene = on_floor({{0, 0.49}, {0, 1.47}}).lasting(2, 0.05);
  const EnergyLedger ledger = ledger_of(scene);
  EXPECT_GT(ledger.projection, 0);
  EXPECT_NEAR(ledger.projection, ledger.potential - ledger.potential_at_start, 1e-6);
}

/// Grains that fall into a turning drum with everything on.
Scene busy_drum() {
  std::vector<Grain> grains;
  for (int k = 0; k < 60; ++k)
    grains.push_back({-3.5 + 1.05 * (k % 8), -2.5 + 1.05 * (k / 8), 0.9 + 0.02 * (k % 5), 0.1 * (k % 3)});
  TestScene scene = scene_of(grains)
                        .between({drum_wall(8)})
                        .with(Gravity{}, Friction{0.4, 0.9}, Restitution{0.46, 0.46}, Spin{})
                        .lasting(30, 0.05)
                        .moving("drum", Rotation{100, {0, 0}});
  scene.solver.tolerance = 1e-2;
  scene.solver.max_sweeps = 30;  // unconverged steps close as well
  return scene;
}

TEST(EnergyLedger, ClosesForADrumAndItsTermsHaveTheirSigns) {
  const Scene busy = busy_drum();
  Scene slides = busy, smooth = busy;
  slides.effects.spin.reset();
  smooth.effects = {Gravity{}};
  for (const Scene& other : {slides, smooth}) EXPECT_GT(ledger_of(other).turnover, 1);
  const EnergyLedger ledger = ledger_of(busy);
  EXPECT_GT(ledger.walls, 0);
  EXPECT_LT(ledger.friction, 0);
  EXPECT_LT(ledger.impacts, 0);
  EXPECT_GE(ledger.projection, 0);
  EXPECT_FALSE(ledger.effects.rolling_resistance || ledger.effects.cohesion);
}

TEST(EnergyLedger, DrivenWallWorksByItsMeanVelocity) {
  // A piston of weight 5 falls on three grains.
  Scene scene = scene_of({{-1.2, 0.5}, {0, 0.5}, {1.2, 0.5}, {0.6, 1.5}})
                    .between({floor_wall(), segment("lid", {-50, 2.6}, {50, 2.6})})
                    .with(Gravity{}, Friction{0.4, 0.4}, Spin{})
                    .lasting(3, 0.02)
                    .moving("lid", pushed({0, -1}, 5, 5));
  const EnergyLedger ledger = ledger_of(scene);
  EXPECT_GT(ledger.turnover, 1);
}

}  // namespace
}  // namespace drumlin
