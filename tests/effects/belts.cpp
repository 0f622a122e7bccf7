// Belts: walls that rest while their surface runs.
#include <numbers>

#include "particles/bodies/arc.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

/// A disc at rest on a belt.
Scene disc_on_belt(double speed, double mu) {
  Scene scene = on_floor({{0, 0.5}});
  scene.effects.friction = Friction{mu, mu};
  add_stage(scene, 3, 1e-2);
  scene.stages[0].motions = {{"floor", Belt{speed / time_s}}};
  scene.output.energy_ledger = true;
  return scene;
}

TEST(Belt, TakesADiscAlongAfterItsSpeedOverMuG) {
  const double mu = 0.25, mass = mass_of_disc(0.5);
  for (const double speed : {0.5, -0.5}) {
    Simulation simulation(disc_on_belt(speed, mu));
    while (!simulation.finished()) {
      (void)simulation.step();
      const double v = std::min(mu * simulation.state().time(), std::abs(speed));  // the belt's after 2
      ASSERT_NEAR(simulation.state().bodies.v_x[0], std::copysign(v, speed), 1e-8);
    }
    EXPECT_NEAR(simulation.state().bodies.z[0], 0.5, 1e-8);
    // The belt works twice what the disc keeps; friction takes the other half.
    const EnergyLedger& ledger = *simulation.state().energy;
    EXPECT_NEAR(ledger.walls, mass * speed * speed, 1e-8);
    EXPECT_NEAR(ledger.friction, -mass * speed * speed / 2, 1e-8);
    EXPECT_LE(std::abs(closing_error(ledger)), 1e-10 * ledger.turnover);
  }
}

TEST(Belt, IsNotFeltWithoutFriction) {
  // Over a crest, off the end of the line, onto a round: nothing pushes along a normal.
  Scene resting = scene_of({{-4, 0.5, 1, 1.5}});
  resting.walls = {{"belt", PolylineShape{{-10, 0, 10}, {0, 0, -2}}}, {"belt", DiscShape{{14, -12}, 6}}};
  resting.effects.gravity = Gravity{};
  add_stage(resting, 14, 2e-3);
  Scene running = resting;
  running.stages[0].motions = {{"belt", Belt{5 / time_s}}};
  const Bodies still = bodies_at_end(resting), carried = bodies_at_end(running);
  EXPECT_LT(still.z[0], -9);  // past both
  EXPECT_NEAR(still.x[0], carried.x[0], 1e-6);
  EXPECT_NEAR(still.z[0], carried.z[0], 1e-6);
}

TEST(Belt, RunsAlongSegmentsAndClockwiseRoundOtherShapes) {
  ShapeStep step;
  step.surface = 0.1;
  const double r = std::sqrt(0.5);
  const Shape line = Segment{{0, 0}, {4, 0}}, disc = FixedDisc{{0, 0}, 2}, drum = Container{{0, 0}, 2};
  const Shape arc = halves_of({0, 0}, 2, 0, std::numbers::pi)[0];
  struct Contact {
    const Shape& shape;
    Point touched, normal, way;
  };
  for (const Contact& c : {Contact{line, {1, 0}, {0, 1}, {0.1, 0}}, Contact{line, {1, 0}, {0, -1}, {0.1, 0}},
                           Contact{line, {4, 0}, {r, r}, {0.1 * r, -0.1 * r}},  // round its end
                           Contact{line, {0, 0}, {-r, r}, {0.1 * r, 0.1 * r}},  // and its beginning
                           Contact{disc, {0, 2}, {0, 1}, {0.1, 0}}, Contact{drum, {0, 2}, {0, -1}, {0.1, 0}},
                           Contact{drum, {0, -2}, {0, 1}, {-0.1, 0}}, Contact{arc, {0, 2}, {0, 1}, {0.1, 0}},
                           Contact{arc, {0, 2}, {0, -1}, {0.1, 0}}}) {
    const Point then = moved(step, c.shape, c.touched, c.normal);
    EXPECT_NEAR(then.x - c.touched.x, c.way.x, 1e-15);
    EXPECT_NEAR(then.z - c.touched.z, c.way.z, 1e-15);
  }
}

}  // namespace
}  // namespace drumlin
