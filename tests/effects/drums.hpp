#pragma once
// A small drum to which tests add one effect, and a box.
#include "tests/support/expect_bodies.hpp"
#include "tests/support/scenes.hpp"

namespace drumlin::test {

/// Adds a stage in seconds, of steps of a millisecond.
inline void add_seconds(TestScene& scene, double duration_s) {
  Stage& stage = scene.lasting(0, 0).stages.back();
  stage.duration_s = duration_s, stage.time_step_s = 1e-3;
}

/// Grains that fall into a drum of 30 mm that turns, with friction, restitution and spin.
inline TestScene turning_drum(int grains = 60) {
  TestScene scene = scene_of(GeneratedGrains{grains, 3, 3.6, CircleRegion{{0, -8}, 20}});
  add_seconds(scene, 0.2);
  return scene.between({drum_wall(30)})
      .with(Gravity{}, Friction{0.4, 0.95}, Restitution{0.46, 0.46}, Spin{})
      .moving("drum", Rotation{60, {0, 0}});
}

/// A box without a lid, 100 steps.
inline TestScene open_box(const GeneratedGrains& grains, double width_mm, double height_mm) {
  TestScene scene = scene_of(grains);
  add_seconds(scene, 0.1);
  return scene
      .between({segment("box", {0, 0}, {width_mm, 0}), segment("box", {0, 0}, {0, height_mm}),
                segment("box", {width_mm, 0}, {width_mm, height_mm})})
      .with(Gravity{}, Friction{0.4, 0.4}, Spin{});
}

}  // namespace drumlin::test
