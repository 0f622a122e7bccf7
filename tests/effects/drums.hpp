#pragma once
// A small drum to which tests add one effect.
#include "tests/support/scenes.hpp"

namespace drumlin::test {

/// Grains that fall into a drum of 30 mm that turns, with friction, restitution and spin.
inline Scene turning_drum(int grains = 60) {
  Scene scene;
  scene.grains.density_kg_m3 = 2700;
  scene.grains.source = GeneratedGrains{grains, 3, 3.6, CircleRegion{{0, -8}, 20}};
  scene.walls = {{"drum", ContainerShape{{0, 0}, 30}}};
  scene.effects = {Gravity{}, Friction{0.4, 0.95}, Restitution{0.46, 0.46}, Spin{}};
  Stage turn;
  turn.name = "turn", turn.duration_s = 0.2, turn.time_step_s = 1e-3;
  turn.motions = {{"drum", Rotation{60, {0, 0}}}};
  scene.stages = {turn};
  return scene;
}

/// A box without a lid, 100 steps.
inline Scene open_box(const GeneratedGrains& grains, double width_mm, double height_mm) {
  Scene scene;
  scene.grains.density_kg_m3 = 2700;
  scene.grains.source = grains;
  scene.walls = {{"box", SegmentShape{{0, 0}, {width_mm, 0}}},
                 {"box", SegmentShape{{0, 0}, {0, height_mm}}},
                 {"box", SegmentShape{{width_mm, 0}, {width_mm, height_mm}}}};
  scene.effects = {Gravity{}, Friction{0.4, 0.4}, std::nullopt, Spin{}};
  Stage stage;
  stage.name = "settle", stage.duration_s = 0.1, stage.time_step_s = 1e-3;
  scene.stages = {stage};
  return scene;
}

}  // namespace drumlin::test
