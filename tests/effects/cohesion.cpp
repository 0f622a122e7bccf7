// Cohesion: a contact pulls with up to c before it opens, and Coulomb's law counts c as load.

#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// A disc below a ceiling at z = 0.
TestScene below_a_ceiling(double cohesion) {
  return scene_of({{0, -0.5}})
      .between({segment("ceiling", {-10, 0}, {10, 0})})
      .with(Gravity{}, Cohesion{0, cohesion})
      .lasting(2, 1e-2);
}

TEST(Cohesion, HoldsADiscBelowACeilingIfItExceedsTheWeight) {
  EndedRun run(below_a_ceiling(1.01));
  EXPECT_NEAR(run.bodies().z[0], -0.5, 1e-9);
  const Snapshot snapshot = run.take_snapshot();
  ASSERT_EQ(snapshot.contacts.size(), 1u);
  // The contact pulls with the weight, not with its strength.
  EXPECT_NEAR(snapshot.contacts[0].impulse_n / snapshot.time_step, -weight, 1e-9);
}

TEST(Cohesion, OfAStageHoldsADiscUntilTheNextStageTakesItAway) {
  TestScene scene = below_a_ceiling(1.01);
  scene.stages[0].effects.cohesion = {0, 0};
  EXPECT_LT(bodies_at_end(scene).z[0], -0.5 - 1.8);  // the effect alone would hold it

  scene.with(Cohesion{0, 0.5}).lasting(2, 1e-2);  // too little
  scene.stages[0].effects.cohesion = {0, 1.01};
  scene.stages[1].effects.cohesion = {0, 0};
  TestRun run(scene);

  run.to_time(2);
  EXPECT_NEAR(run.bodies().z[0], -0.5, 1e-9);
  run.to_time(2.1);
  // Free fall from the first step of the second stage on.
  EXPECT_NEAR(run.bodies().v_z[0], -0.1, 1e-9);
  run.to_time(4);
  EXPECT_LT(run.bodies().z[0], -0.5 - 1.8);
}

/// Speed after a time of 1 of a disc that cannot turn, on a floor in gravity tilted by 30 degrees.
double speed_on_a_slope(double mu, double cohesion) {
  return bodies_at_end(on_floor({{0, 0.5}})
                           .with(Gravity{9.81, -60}, Friction{mu, mu}, Cohesion{0, cohesion})
                           .lasting(1, 1e-2))
      .v_x[0];
}

TEST(Cohesion, AddsToTheLoadInCoulombsLaw) {
  // At rest iff sin 30 <= mu (cos 30 + c); else it slides with a = sin 30 - mu (cos 30 + c).
  const double s = 0.5, c = std::sqrt(0.75), mu = 0.3;
  const double needed = s / mu - c;  // 0.80
  EXPECT_NEAR(speed_on_a_slope(mu, needed + 0.01), 0, 1e-9);
  EXPECT_NEAR(speed_on_a_slope(mu, 0.5), s - mu * (c + 0.5), 1e-8);
}

TEST(Cohesion, PullsTwoDiscsApartOnlyByMoreThanItsForce) {
  // Two discs hang one below the other from the ceiling: the upper contact carries two weights, the lower
  // one.
  const auto lowest = [](double grain_grain, double grain_wall) {
    return bodies_at_end(scene_of({{0, -0.5}, {0, -1.5}})
                             .between({segment("ceiling", {-10, 0}, {10, 0})})
                             .with(Gravity{}, Cohesion{grain_grain, grain_wall})
                             .lasting(2, 1e-2))
        .z;
  };
  EXPECT_NEAR(lowest(1.05, 2.05)[1], -1.5, 1e-6);
  EXPECT_LT(lowest(0.95, 2.05)[1], -1.5 - 0.1);    // the lower one falls ...
  EXPECT_NEAR(lowest(0.95, 2.05)[0], -0.5, 1e-6);  // ... alone
  EXPECT_LT(lowest(1.05, 1.95)[0], -0.5 - 0.01);   // both fall
}

}  // namespace
}  // namespace drumlin
