// Static and kinetic friction: closed forms of discs that stick or slide.
#include <cmath>

#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

constexpr double mu_static = 0.5, mu_kinetic = 0.2;

/// A disc at v on a floor in gravity tilted so that its slope is `slope`; with `spin` it may roll.
Scene tilted_disc(double v, double slope, double duration, bool spin = false) {
  Scene scene = on_floor({{0, 0.5, 1, v}});
  scene.effects.gravity = Gravity{9.81, -90 + std::atan(slope) * 180 / std::numbers::pi};
  scene.effects.friction = Friction{mu_static, mu_static};
  scene.effects.kinetic_friction = KineticFriction{{mu_kinetic, mu_kinetic}};
  if (spin) scene.effects.spin.emplace();
  add_stage(scene, duration, 1e-2);
  return scene;
}
double sin_of(double slope) { return slope / std::hypot(1, slope); }
double cos_of(double slope) { return 1 / std::hypot(1, slope); }
double speed_after(double v, double slope, double duration, bool spin = false) {
  return bodies_at_end(tilted_disc(v, slope, duration, spin)).v_x[0];
}

// The acceleration is constant, which implicit steps integrate without an error of velocities.
TEST(KineticFriction, ADiscThatCannotTurnSticksBelowStaticFrictionAndSlidesOn) {
  const auto sliding = [](double slope) { return sin_of(slope) - mu_kinetic * cos_of(slope); };
  EXPECT_NEAR(speed_after(0, 0.45, 3), 0, 1e-9);  // between the two, at rest
  EXPECT_NEAR(speed_after(0.1, 0.45, 3), 0.1 + 3 * sliding(0.45), 1e-7);
  EXPECT_NEAR(speed_after(0, 0.55, 3), 3 * sliding(0.55), 1e-7);
  EXPECT_NEAR(speed_after(1, 0, 4), 1 - 4 * mu_kinetic, 1e-7);
  EXPECT_NEAR(speed_after(1, 0, 6), 0, 1e-9);  // stopped after 5
}

TEST(KineticFriction, ADiscRollsBelowThreeTimesStaticFrictionAndSkidsOn) {
  EXPECT_NEAR(speed_after(0, 1.4, 2, true), 2 * sin_of(1.4) * 2 / 3, 1e-6);
  const auto skidding = [](double slope) { return sin_of(slope) - mu_kinetic * cos_of(slope); };
  EXPECT_NEAR(speed_after(0.1, 1.4, 2, true), 0.1 + 2 * skidding(1.4), 1e-6);
  EXPECT_NEAR(speed_after(0, 1.6, 2, true), 2 * skidding(1.6), 1e-6);
  EXPECT_NEAR(speed_after(1, 0, 3, true), 2.0 / 3,
              1e-6);  // rolls after 1/(3 mu_kinetic), whatever mu_kinetic is
}

TEST(KineticFriction, OfAnImpactIsTheKineticOne) {
  const double e = 0.5, v_t = 1, v_n = 0.3;
  Scene scene = scene_of({{0, 0.55, 1, v_t, -v_n}});
  scene.walls = {floor_wall()};
  scene.effects.friction = Friction{mu_static, mu_static};
  scene.effects.restitution = Restitution{e, e};
  scene.effects.kinetic_friction = KineticFriction{{mu_kinetic, mu_kinetic}};
  add_stage(scene, 0.5, 1e-2);
  EXPECT_NEAR(bodies_at_end(scene).v_x[0], v_t - mu_kinetic * (1 + e) * v_n, 1e-8);
}

}  // namespace
}  // namespace drumlin
