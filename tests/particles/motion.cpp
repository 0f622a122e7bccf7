// Closed forms that a single grain, or a few, must follow (particles.md of the literature: impact, sliding,
// rolling).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/scenes.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

TEST(RotatingContainer, GrainOnTheWallTurnsWithItAndDoesNotDrift) {
  const double turns = 10, spin = 0.5;  // centripetal acceleration presses it to the wall
  Scene scene = scene_of({{0, -9.5, 1, -9.5 * spin, 0, spin}});
  scene.walls = {{"drum", ContainerShape{{0, 0}, 10}}};
  scene.effects.friction = Friction{0.9, 0.9};
  scene.effects.spin = Spin{};
  add_stage(scene, turns * 2 * std::numbers::pi / spin, 0.05);
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

}  // namespace
}  // namespace drumlin
