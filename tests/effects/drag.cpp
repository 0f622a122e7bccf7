// Drag: closed forms of free discs, and that forces keep their size beside it for any time step.

#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// Rates in the units of the run.
Drag drag(double rate, std::optional<double> spin_rate = {}, DragOver grows_with = DragOver::mass) {
  if (spin_rate) spin_rate = *spin_rate / time_s;
  return {rate / time_s, spin_rate, grows_with};
}

TEST(Drag, LetsVelocityAndSpinDecayExponentiallyAndBooksWhatItTakes) {
  Scene scene =
      scene_of({{0, 0, 1, 2, 1, 3}}).with(Friction{0.3, 0.3}, Spin{}, drag(0.7, 1.3)).lasting(4, 0.1);
  scene.output.energy_ledger = true;
  TestRun run(scene);
  run.each_step([&] {
    const double t = run.time();
    const Bodies& b = run.bodies();
    ASSERT_NEAR(b.v_x[0], 2 * std::exp(-0.7 * t), 1e-13);
    ASSERT_NEAR(b.v_z[0], std::exp(-0.7 * t), 1e-13);
    ASSERT_NEAR(b.spin[0], 3 * std::exp(-1.3 * t), 1e-13);
    const double of_spin = weight * 0.25 * 9 / 4;  // J omega^2 / 2
    ASSERT_NEAR(*run.state().energy->effects.drag,
                weight * 5 / 2 * std::expm1(-1.4 * t) + of_spin * std::expm1(-2.6 * t), 1e-12);
  });
}

TEST(Drag, StopsADiscAfterItsSpeedOverTheRate) {
  // The mean of the velocities of a step is the trapezoidal rule: of second order.
  const auto missed = [](double h) {
    return bodies_at_end(scene_of({{0, 0, 1, 2}}).with(drag(0.7)).lasting(4, h)).x[0] -
           2 / 0.7 * (1 - std::exp(-0.7 * 4));
  };
  EXPECT_NEAR(missed(0.2) / missed(0.1), 4, 0.02);
  EXPECT_NEAR(missed(0.1), 2 / 0.7 * (1 - std::exp(-0.7 * 4)) * 0.07 * 0.07 / 12, 1e-6);
}

TEST(Drag, LetsADiscFallAtItsTerminalVelocity) {
  for (const double rate : {0.1, 10.0, 1000.0}) {  // rate h = 0.01, 1 and 100
    TestRun run(scene_of({{0, 0}}).with(Gravity{}, drag(rate)).lasting(3, 0.1));
    run.each_step([&] {
      const double expected = std::expm1(-rate * run.time()) / rate;
      ASSERT_NEAR(run.bodies().v_z[0], expected, 1e-12) << rate;
    });
  }
}

TEST(Drag, OfAFluidSlowsSmallDiscsFaster) {
  // Force ~ D, mass ~ D^2, and couple ~ D^3, inertia ~ D^4: rates ~ 1 / D.
  const Bodies end = bodies_at_end(scene_of({{0, 0, 0.5, 1, 0, 2}, {0, 5, 1.5, 1, 0, 2}})
                                       .with(Friction{0.3, 0.3}, Spin{}, drag(0.6, 0.9, DragOver::diameter))
                                       .lasting(1, 0.1));
  EXPECT_NEAR(end.v_x[0], std::exp(-0.6 / 0.5), 1e-13);
  EXPECT_NEAR(end.v_x[1], std::exp(-0.6 / 1.5), 1e-13);
  EXPECT_NEAR(end.spin[0], 2 * std::exp(-0.9 / 0.5), 1e-13);
  EXPECT_NEAR(end.spin[1], 2 * std::exp(-0.9 / 1.5), 1e-13);
}

TEST(Drag, LeavesADiscAtRestItsWeight) {
  for (const double rate : {0.1, 100.0}) {
    EndedRun run(on_floor({{0, 0.5}, {0, 1.5}}).with(drag(rate)).lasting(1, 0.05));
    const Snapshot snapshot = run.take_snapshot();
    ASSERT_EQ(snapshot.contacts.size(), 2u);
    for (const SnapshotContact& contact : snapshot.contacts)
      EXPECT_NEAR(contact.impulse_n / snapshot.time_step, (contact.j < 0 ? 2 : 1) * weight, 1e-8);
  }
}

TEST(Drag, LetsCohesionHoldWhatItHoldsWithout) {
  // With 0.99 weights a disc leaves the ceiling, and falls at 0.01 / rate at first.
  for (const double cohesion : {0.99, 1.01}) {
    EXPECT_NEAR(bodies_at_end(scene_of({{0, -0.5}})
                                  .between({segment("ceiling", {-10, 0}, {10, 0})})
                                  .with(Gravity{}, Cohesion{0, cohesion}, drag(50))
                                  .lasting(2, 0.05))
                    .z[0],
                -0.5 - (cohesion < 1 ? 4e-4 : 0), 5e-5);
  }
}

TEST(Drag, HoldsADiscBackOnABelt) {
  // Friction mu g against rate v: v = mu g / rate (1 - exp(-rate t)), and never more than the belt's speed.
  const double mu = 0.3;
  for (const double rate : {0.5, 5.0, 0.2}) {
    Scene scene = on_floor({{0, 0.5}})
                      .with(Friction{mu, mu}, drag(rate))
                      .lasting(10, 0.1)
                      .moving("floor", Belt{1 / time_s});  // speed 1
    TestRun run(scene);
    run.each_step([&] {
      const double t = run.time();
      ASSERT_NEAR(run.bodies().v_x[0], std::min(1.0, -mu / rate * std::expm1(-rate * t)), 1e-8);
    });
  }
}

}  // namespace
}  // namespace drumlin
