#pragma once
// A small drum to which tests add one effect.
#include <gtest/gtest.h>

#include "particles/stepping/simulation.hpp"
#include "tests/support/scenes.hpp"

namespace drumlin::test {

/// Grains that fall into a drum of 30 mm that turns, with friction, restitution and spin.
inline particles::Scene turning_drum(int grains = 60) {
  particles::Scene scene;
  scene.grains.density_kg_m3 = 2700;
  scene.grains.source = particles::GeneratedGrains{grains, 3, 3.6, particles::CircleRegion{{0, -8}, 20}};
  scene.walls = {{"drum", particles::ContainerShape{{0, 0}, 30}}};
  scene.effects = {particles::Gravity{}, particles::Friction{0.4, 0.95}, particles::Restitution{0.46, 0.46},
                   particles::Spin{}};
  particles::Stage turn;
  turn.name = "turn", turn.duration_s = 0.2, turn.time_step_s = 1e-3;
  turn.motions = {{"drum", particles::Rotation{60, {0, 0}}}};
  scene.stages = {turn};
  return scene;
}

/// A box without a lid, 100 steps.
inline particles::Scene open_box(const particles::GeneratedGrains& grains, double width_mm,
                                 double height_mm) {
  particles::Scene scene;
  scene.grains.density_kg_m3 = 2700;
  scene.grains.source = grains;
  scene.walls = {{"box", particles::SegmentShape{{0, 0}, {width_mm, 0}}},
                 {"box", particles::SegmentShape{{0, 0}, {0, height_mm}}},
                 {"box", particles::SegmentShape{{width_mm, 0}, {width_mm, height_mm}}}};
  scene.effects = {particles::Gravity{}, particles::Friction{0.4, 0.4}, std::nullopt, particles::Spin{}};
  particles::Stage stage;
  stage.name = "settle", stage.duration_s = 0.1, stage.time_step_s = 1e-3;
  scene.stages = {stage};
  return scene;
}

inline particles::Bodies bodies_at_end(const particles::Scene& scene) {
  particles::Simulation simulation(scene);
  while (!simulation.finished()) (void)simulation.step();
  return simulation.state().bodies;
}

/// To the last bit.
inline void expect_same(const particles::Bodies& a, const particles::Bodies& b) {
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.z, b.z);
  EXPECT_EQ(a.v_x, b.v_x);
  EXPECT_EQ(a.v_z, b.v_z);
  EXPECT_EQ(a.spin, b.spin);
}

}  // namespace drumlin::test
