// Several motions of one wall: each acts on what those before it leave.
#include <numbers>

#include "particles/scene/scene_walls.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

TEST(ComposedMotions, ActInTheirOrder) {
  const double spin = 0.7, v = 0.3, t = 2, angle = spin * t;
  const WallMotion turn{"vane", Rotation{rpm_of(spin), {1, 0}}}, glide{"vane", Translation{{v / time_s, 0}}};
  for (const bool turns_first : {true, false}) {
    Scene scene = scene_of({{50, 50}});
    scene.walls = {{"vane", SegmentShape{{1, 0}, {4, 0}}}};
    add_stage(scene, 5, 1e-2);
    scene.stages[0].motions = turns_first ? std::vector{turn, glide} : std::vector{glide, turn};
    Walls walls = walls_of(scene, scales_of(scene));
    begin_stage(walls, scene.stages[0], scales_of(scene), 0);
    // Turned about its hub, which then glides; or, glided, about the place where the hub was.
    const auto tip_at = [&](double time) {
      const double reach = turns_first ? 3 : 3 + v * time, hub = turns_first ? 1 + v * time : 1;
      return Point{hub + reach * std::cos(spin * time), -reach * std::sin(spin * time)};
    };
    const Point tip = std::get<Segment>(walls.shapes_at(t)[0]).to;
    EXPECT_NEAR(tip.x, tip_at(t).x, 1e-12);
    EXPECT_NEAR(tip.z, tip_at(t).z, 1e-12);
    EXPECT_NEAR(walls.pose(0, t).angle, angle, 1e-12);
    // And the material of the tip over a step.
    const double h = 0.01;
    const WallStep step = wall_step(walls, t, h);
    const Point then = moved(step.displacement[0], tip);
    EXPECT_NEAR(then.x, tip_at(t + h).x, 1e-12);
    EXPECT_NEAR(then.z, tip_at(t + h).z, 1e-12);
  }
}

TEST(ComposedMotions, ADrumThatTurnsAndGlidesIsADrumThatTurns) {
  // Seen by who glides with it. Gliding grains in a gliding drum, in powers of two so that little is rounded.
  const double v = 0.25;
  const auto end_of = [&](double glide) {
    Scene scene = scene_of({{-1, -3, 1, glide}, {0.125, -3, 1, glide}, {1.25, -3, 1, glide}});
    scene.walls = {{"drum", ContainerShape{{0, 0}, 4}}};
    scene.effects = {Gravity{}, Friction{0.3, 0.5}, std::nullopt, Spin{}};
    add_stage(scene, 4, 0x1p-8);
    scene.stages[0].motions = {{"drum", Rotation{rpm_of(0.5), {0, 0}}}};
    if (glide != 0) scene.stages[0].motions.push_back({"drum", Translation{{glide / time_s, 0}}});
    return bodies_at_end(scene);
  };
  const Bodies turned = end_of(0), carried = end_of(v);
  EXPECT_GT(std::abs(turned.spin[0]), 0.1);
  for (std::size_t b = 0; b < 3; ++b) {
    EXPECT_NEAR(carried.x[b] - 4 * v, turned.x[b], 1e-6) << b;
    EXPECT_NEAR(carried.z[b], turned.z[b], 1e-6) << b;
    EXPECT_NEAR(carried.spin[b], turned.spin[b], 1e-5) << b;
  }
}

TEST(ComposedMotions, ARollerTurnsWhileAForcePressesIt) {
  // It falls by F t^2 / (2 m), to first order in the step, and turns about its own centre.
  Scene scene = scene_of({{0, 0.5}});
  const double h = 0.01, spin = 0.5, force = 2, mass = 4, unit = 2700e-6, newton = 2700e-6 * 9.81;
  scene.walls = {floor_wall(), {"roller", DiscShape{{0, 3}, 2}}};
  add_stage(scene, 1, h);
  scene.stages[0].motions = {{"roller", Rotation{rpm_of(spin), {0, 3}}},
                             {"roller", ForceControl{{0, -1}, force * newton, mass * unit}}};
  EndedSimulation simulation(scene);
  const Walls& walls = simulation.walls();
  const Pose pose = walls.pose(1, 1, simulation.state().driven);
  EXPECT_NEAR(pose.angle, spin, 1e-12);
  const Shape pressed = walls.shapes_at(1, simulation.state().driven)[1];
  const auto& roller = std::get<FixedDisc>(pressed);
  EXPECT_NEAR(roller.center.x, 0, 1e-12);
  EXPECT_NEAR(roller.center.z, 3 - force / mass / 2, force / mass * h);
}

}  // namespace
}  // namespace drumlin
