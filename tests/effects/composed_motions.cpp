// Several motions of one wall: each acts on what those before it leave.

#include "particles/scene/scene_walls.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

TEST(ComposedMotions, ActInTheirOrder) {
  const double spin = 0.7, v = 0.3, t = 2, angle = spin * t;
  const WallMotion turn{"vane", turning(spin, {1, 0})}, glide{"vane", Translation{{v / time_s, 0}}};
  for (const bool turns_first : {true, false}) {
    Scene scene = scene_of({{50, 50}}).between({segment("vane", {1, 0}, {4, 0})}).lasting(5, 1e-2);
    scene.stages[0].motions = turns_first ? std::vector{turn, glide} : std::vector{glide, turn};
    Walls walls = walls_of(scene, scales_of(scene));
    begin_stage(walls, scene.stages[0], scales_of(scene), 0);
    // Turned about its hub, which then glides; or, glided, about the place where the hub was.
    const auto tip_at = [&](double time) {
      const double reach = turns_first ? 3 : 3 + v * time, hub = turns_first ? 1 + v * time : 1;
      return Point{hub + reach * std::cos(spin * time), -reach * std::sin(spin * time)};
    };
    const Point tip = std::get<Segment>(walls.shapes_at(t)[0]).to;
    expect_near(tip, tip_at(t), 1e-12);
    EXPECT_NEAR(walls.pose(0, t).angle, angle, 1e-12);
    // And the material of the tip over a step.
    const double h = 0.01;
    const WallStep step = wall_step(walls, t, h);
    const Point then = moved(step.displacement[0], tip);
    expect_near(then, tip_at(t + h), 1e-12);
  }
}

TEST(ComposedMotions, ADrumThatTurnsAndGlidesIsADrumThatTurns) {
  // Seen by who glides with it. Gliding grains in a gliding drum, in powers of two so that little is rounded.
  const double v = 0.25;
  const auto end_of = [&](double glide) {
    TestScene scene = scene_of({{-1, -3, 1, glide}, {0.125, -3, 1, glide}, {1.25, -3, 1, glide}})
                          .between({drum_wall(4)})
                          .with(Gravity{}, Friction{0.3, 0.5}, Spin{})
                          .lasting(4, 0x1p-8)
                          .moving("drum", turning(0.5));
    Bodies end = bodies_at_end(glide == 0 ? scene : scene.moving("drum", Translation{{glide * mm_s, 0}}));
    for (double& x : end.x) x -= 4 * glide;
    return end;
  };
  const Bodies turned = end_of(0);
  EXPECT_GT(std::abs(turned.spin[0]), 0.1);
  expect_near(end_of(v), turned, 1e-6);
}

TEST(ComposedMotions, ARollerTurnsWhileAForcePressesIt) {
  // It falls by F t^2 / (2 m), to first order in the step, and turns about its own centre.
  const double h = 0.01, spin = 0.5, force = 2, mass = 4;
  const EndedRun run(scene_of({{0, 0.5}})
                         .between({floor_wall(), {"roller", DiscShape{{0, 3}, 2}}})
                         .lasting(1, h)
                         .moving("roller", turning(spin, {0, 3}))
                         .moving("roller", pushed({0, -1}, force, mass)));
  const Walls& walls = run.walls();
  const Pose pose = walls.pose(1, 1, run.state().driven);
  EXPECT_NEAR(pose.angle, spin, 1e-12);
  const Shape pressed = walls.shapes_at(1, run.state().driven)[1];
  const auto& roller = std::get<FixedDisc>(pressed);
  EXPECT_NEAR(roller.center.x, 0, 1e-12);
  EXPECT_NEAR(roller.center.z, 3 - force / mass / 2, force / mass * h);
}

}  // namespace
}  // namespace drumlin
