// Belts: walls that rest while their surface runs.
#include <numbers>

#include "particles/bodies/arc.hpp"
#include "tests/effects/drums.hpp"

namespace drumlin {
using namespace particles;
using namespace test;
namespace {

TEST(Belt, AndAFloorThatGlidesTakeADiscAlongAfterTheirSpeedOverMuG) {
  const double mu = 0.25;
  for (const double speed : {0.5, -0.5})
    for (const bool glides : {false, true}) {
      TestScene scene = on_floor({{0, 0.5}}).with(Friction{mu, mu}).lasting(3, 1e-2);
      scene.output.energy_ledger = true;
      TestRun run(glides ? scene.moving("floor", Translation{{speed * mm_s, 0}})
                         : scene.moving("floor", Belt{speed * mm_s}));
      run.each_step([&] {
        const double v = std::min(mu * run.time(), std::abs(speed));  // the floor's after 2
        ASSERT_NEAR(run.bodies().v_x[0], std::copysign(v, speed), 1e-8);
      });
      EXPECT_NEAR(run.bodies().z[0], 0.5, 1e-8);
      // The floor works twice what the disc keeps; friction takes the other half.
      const EnergyLedger& ledger = *run.state().energy;
      EXPECT_NEAR(ledger.walls, weight * speed * speed, 1e-8);
      EXPECT_NEAR(ledger.friction, -weight * speed * speed / 2, 1e-8);
      EXPECT_LE(std::abs(closing_error(ledger)), 1e-10 * ledger.turnover);
    }
}

TEST(Belt, IsNotFeltWithoutFriction) {
  // Over a crest, off the end of the line, onto a round: nothing pushes along a normal.
  TestScene resting =
      scene_of({{-4, 0.5, 1, 1.5}})
          .between({{"belt", PolylineShape{{-10, 0, 10}, {0, 0, -2}}}, {"belt", DiscShape{{14, -12}, 6}}})
          .with(Gravity{})
          .lasting(14, 2e-3);
  const Bodies still = bodies_at_end(resting);
  EXPECT_LT(still.z[0], -9);  // past both
  expect_near(still, bodies_at_end(resting.moving("belt", Belt{5 * mm_s})), 1e-6);
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
    expect_near(Point{then.x - c.touched.x, then.z - c.touched.z}, c.way, 1e-15);
  }
}

}  // namespace
}  // namespace drumlin
