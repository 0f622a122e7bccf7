// Cohesion: a contact pulls with up to c before it opens, and Coulomb's law counts c as load.
#include <numbers>

#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

const double weight = std::numbers::pi / 4;  // of a disc of diameter 1

/// A disc below a ceiling at z = 0.
Scene below_a_ceiling(double cohesion) {
  Scene scene = scene_of({{0, -0.5}});
  scene.walls = {{"ceiling", SegmentShape{{-10, 0}, {10, 0}}}};
  scene.effects.gravity = Gravity{};
  scene.effects.cohesion = Cohesion{0, cohesion};
  add_stage(scene, 2, 1e-2);
  return scene;
}

TEST(Cohesion, HoldsADiscBelowACeilingIfItExceedsTheWeight) {
  EndedSimulation simulation(below_a_ceiling(1.01));
  EXPECT_NEAR(simulation.state().bodies.z[0], -0.5, 1e-9);
  const Snapshot snapshot = simulation.take_snapshot();
  ASSERT_EQ(snapshot.contacts.size(), 1u);
  // The contact pulls with the weight, not with its strength.
  EXPECT_NEAR(snapshot.contacts[0].impulse_n / snapshot.time_step, -weight, 1e-9);
}

TEST(Cohesion, OfAStageHoldsADiscUntilTheNextStageTakesItAway) {
  Scene scene = below_a_ceiling(1.01);
  scene.stages[0].effects.cohesion = {0, 0};
  EXPECT_LT(bodies_at_end(scene).z[0], -0.5 - 1.8);  // the effect alone would hold it

  scene.effects.cohesion = Cohesion{0, 0.5};  // too little
  scene.stages[0].effects.cohesion = {0, 1.01};
  add_stage(scene, 2, 1e-2);
  scene.stages[1].effects.cohesion = {0, 0};
  Simulation simulation(scene);
  const auto go_on_to = [&](double time) {
    while (simulation.state().time() < time - 1e-9) (void)simulation.step();
  };
  go_on_to(2);
  EXPECT_NEAR(simulation.state().bodies.z[0], -0.5, 1e-9);
  go_on_to(2.1);
  // Free fall from the first step of the second stage on.
  EXPECT_NEAR(simulation.state().bodies.v_z[0], -0.1, 1e-9);
  go_on_to(4);
  EXPECT_LT(simulation.state().bodies.z[0], -0.5 - 1.8);
}

/// Speed after a time of 1 of a disc that cannot turn, on a floor in gravity tilted by 30 degrees.
double speed_on_a_slope(double mu, double cohesion) {
  Scene scene = on_floor({{0, 0.5}});
  scene.effects.gravity = Gravity{9.81, -60};
  scene.effects.friction = Friction{mu, mu};
  scene.effects.cohesion = Cohesion{0, cohesion};
  add_stage(scene, 1, 1e-2);
  return bodies_at_end(scene).v_x[0];
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
    Scene scene = scene_of({{0, -0.5}, {0, -1.5}});
    scene.walls = {{"ceiling", SegmentShape{{-10, 0}, {10, 0}}}};
    scene.effects.gravity = Gravity{};
    scene.effects.cohesion = Cohesion{grain_grain, grain_wall};
    add_stage(scene, 2, 1e-2);
    return bodies_at_end(scene).z;
  };
  EXPECT_NEAR(lowest(1.05, 2.05)[1], -1.5, 1e-6);
  EXPECT_LT(lowest(0.95, 2.05)[1], -1.5 - 0.1);    // the lower one falls ...
  EXPECT_NEAR(lowest(0.95, 2.05)[0], -0.5, 1e-6);  // ... alone
  EXPECT_LT(lowest(1.05, 1.95)[0], -0.5 - 0.01);   // both fall
}

}  // namespace
}  // namespace drumlin
