// A frame that turns: what happens in it is what happens in the laboratory.
#include <numbers>

#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

TEST(RotatingFrame, FreeFlightIsStraightInTheLaboratory) {
  const double spin = 0.7;
  const Point c{1, -2};
  const Bodies end =
      bodies_at_end(scene_of({{3, 1, 1, 0.4, -0.2, 0.1}})
                        .with(RotatingFrame{rpm_of(spin), {c.x, c.z}}, Friction{0.1, 0.1}, Spin{})
                        .lasting(5, 0.05));
  // In the laboratory the velocity is that in the frame plus that of the frame there.
  const double v_x = 0.4 + spin * (1 - c.z), v_z = -0.2 - spin * (3 - c.x);
  const double X = 3 + 5 * v_x - c.x, Z = 1 + 5 * v_z - c.z, angle = 5 * spin;
  // Turned back, anticlockwise, by the angle of the frame. Times in s and back: 1e-12 relative.
  EXPECT_NEAR(end.x[0], c.x + std::cos(angle) * X - std::sin(angle) * Z, 1e-10);
  EXPECT_NEAR(end.z[0], c.z + std::sin(angle) * X + std::cos(angle) * Z, 1e-10);
  EXPECT_NEAR(end.spin[0], 0.1, 1e-12);
}

TEST(RotatingFrame, GravityKeepsItsDirectionInTheLaboratory) {
  const double spin = std::numbers::pi / 4, h = 1e-3;  // an eighth of a turn in a time of 1
  EndedRun run(scene_of({{0, 0}}).with(Gravity{}, RotatingFrame{rpm_of(spin), {0, 0}}).lasting(1, h));
  const double fall = 0.5;
  EXPECT_NEAR(run.bodies().x[0], fall * std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(run.bodies().z[0], -fall * std::sqrt(0.5), 1e-9);
  const Snapshot snapshot = run.take_snapshot();
  EXPECT_NEAR(snapshot.gravity_x, std::sqrt(0.5), 1e-9);
  EXPECT_NEAR(snapshot.gravity_z, -std::sqrt(0.5), 1e-9);
}

TEST(RotatingFrame, ADrumSeenFromItselfMovesAsSeenFromOutside) {
  const double spin = 0.4, duration = 3;
  std::vector<Grain> seen_outside, seen_inside;
  for (int k = 0; k < 9; ++k) {
    Grain g{1.05 * (k % 3) - 1, 1.05 * (k / 3) - 3.5, 1, 0, 0, 0};
    seen_outside.push_back(g);
    g.v_x = -spin * g.z, g.v_z = spin * g.x, g.spin = -spin;
    seen_inside.push_back(g);
  }
  const auto end = [&](const std::vector<Grain>& grains, bool inside) {
    TestScene scene = scene_of(grains)
                          .between({drum_wall(5), segment("drum", {0, -5}, {0, -4.5})})
                          .with(Gravity{}, Friction{0.4, 0.6}, Restitution{0.3, 0.3}, Spin{})
                          .lasting(duration, 0.01);
    scene.solver.tolerance = 1e-11;
    return bodies_at_end(inside ? scene.with(RotatingFrame{rpm_of(spin), {0, 0}})
                                : scene.moving("drum", turning(spin)));
  };
  Bodies inside = end(seen_inside, true);
  for (std::size_t k = 0; k < inside.count(); ++k) {
    const Point at = moved(Pose{spin * duration, 0, 0}, {inside.x[k], inside.z[k]});
    inside.x[k] = at.x, inside.z[k] = at.z, inside.spin[k] += spin;
  }
  // The solver's tolerance, times what 300 steps with impacts make of a small difference.
  expect_near(inside, end(seen_outside, false), 1e-6);
}

}  // namespace
}  // namespace drumlin
