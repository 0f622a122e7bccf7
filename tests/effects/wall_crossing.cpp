// Discs that a step takes through walls, and what the check of the step makes of them.
#include "particles/stepping/wall_crossing.hpp"

#include <numbers>

#include "particles/bodies/arc.hpp"
#include "tests/support/expect_bodies.hpp"

namespace drumlin::test {
using namespace particles;
namespace {

struct Crossing {
  const char* what;
  std::vector<Shape> walls;
  Point from, to;           ///< of the disc's centre
  std::optional<Point> at;  ///< where it is laid back to; none: it stays where it went
  Pose move = {};           ///< of all walls in the step
  double radius = 0.5;
  Period period = {};
};

struct Undone {
  Point at;
  double depth = 0;
};
Undone undone(const Crossing& crossing) {
  WallStep step;
  for (const Shape& wall : crossing.walls) {
    step.before.push_back(wall);
    step.after.push_back(moved(Rigid(crossing.move), wall));
    step.displacement.push_back(crossing.move);
  }
  Bodies bodies;
  add_body(bodies, crossing.from.x, crossing.from.z, crossing.radius);
  WallCrossings crossings;
  crossings.begin(bodies, step.before, 1);
  bodies.x[0] = crossing.to.x, bodies.z[0] = crossing.to.z;
  const Crossings found = crossings.undo(step, crossing.period, bodies);
  EXPECT_FALSE(found.lost) << crossing.what;
  return {{bodies.x[0], bodies.z[0]}, found.deepest};
}

TEST(WallCrossing, IsUndoneOntoTheSideItCameFrom) {
  const std::vector<Shape> floor{Segment{{-2, 0}, {2, 0}}}, period{Segment{{0, 0}, {10, 0}}},
      drum{Container{{0, 0}, 5}};
  const auto halves = halves_of({0, 0}, 5, 0, std::numbers::pi);
  const std::vector<Shape> arc{halves[0], halves[1]};
  const Pose turn{0.2, 0, 0};
  const Point beyond{5.2 * std::cos(-0.1), 5.2 * std::sin(-0.1)};
  for (const Crossing& one : {
           Crossing{"from above", floor, {0, 0.8}, {0, -0.2}, Point{0, 0.5}},
           Crossing{"from below", floor, {0, -0.8}, {0, 0.2}, Point{0, -0.5}},
           Crossing{"the wall passed the disc", floor, {0, 0.05}, {0, 0.05}, Point{0, 0.6}, {0, 0, 0.1}},
           Crossing{"deep, but not through", floor, {0, 0.05}, {0, 0.05}, {}},
           Crossing{"past its end", floor, {3, 0.8}, {3, -0.2}, {}},
           // The way crosses a floor as long as the period just where the period ends.
           Crossing{
               "before the seam", period, {-0.01, 0.1}, {0.02, -0.2}, Point{0.02, 0.5}, {}, 0.5, {0, 10}},
           Crossing{"at it", period, {9.99, 0.1}, {10.02, -0.2}, Point{10.02, 0.5}, {}, 0.5, {0, 10}},
           Crossing{"beyond it", period, {20.02, 0.1}, {20.05, -0.2}, Point{20.05, 0.5}, {}, 0.5, {0, 10}},
           Crossing{"out of a drum", drum, {4.8, 0}, {5.2, 0}, Point{4.9, 0}, {}, 0.1},
           Crossing{"within it", drum, {4.8, 0}, {4.95, 0}, {}, {}, 0.1},
           Crossing{"further than the largest radius", drum, {4.1, 0}, {5.2, 0}, {}, {}, 0.1},
           Crossing{"was outside before", drum, {5.1, 0}, {5.2, 0}, {}, {}, 0.1},
           Crossing{"outwards, at the joint", arc, {0, 4.8}, {0, 5.4}, Point{0, 4.5}},
           Crossing{"inwards", arc, {0, 5.2}, {0, 4.7}, Point{0, 5.5}},
           Crossing{"the arc passed the disc", arc, {0, 5.1}, {0, 5.1}, Point{0, 5.8}, {0, 0, 0.3}},
           Crossing{"deep in an arc, but not through", arc, {0, 5.5}, {0, 5.1}, {}},
           Crossing{"past the end of an arc", arc, {4.9, -0.2}, {5.4, -0.2}, {}},
           // Its end passes a disc that stands just beyond it, on neither side.
           Crossing{"an end that passes", arc, beyond, beyond, {}, turn},
       }) {
    SCOPED_TRACE(one.what);
    const Undone found = undone(one);
    const Point expected = one.at.value_or(one.to);
    expect_near(found.at, expected, one.at ? 1e-12 : 0);
    EXPECT_NEAR(found.depth, std::hypot(expected.x - one.to.x, expected.z - one.to.z), 1e-12);
  }
}

TEST(WallCrossing, OfAWallThatTurnsIsSeenFromTheWall) {
  // The end of an arm sweeps over a disc at rest, which stays before it.
  const Pose turn{0.03, 0, 0};
  const Undone found = undone({"arm", {Segment{{0, 0}, {10, 0}}}, {9, -0.1}, {9, -0.1}, {}, turn});
  EXPECT_GT(found.depth, 0.5);
  EXPECT_NEAR(moved(inverse(turn), found.at).z, -0.5, 1e-12);
}

TEST(WallCrossing, InACornerEndsWithinBothWalls) {
  const std::vector<Shape> corner{Segment{{0, 0}, {10, 0}}, Segment{{0, 0}, {0, 10}}};
  for (const double slope : {0.5, 1.0, 2.0}) {
    const Undone found = undone({"corner", corner, {0.3, 0.3}, {0.3 - 0.4 * slope, -0.1}, {}});
    EXPECT_GT(found.at.x, 0) << slope;
    EXPECT_GT(found.at.z, 0) << slope;
  }
}

TEST(WallCrossing, OfManySidesLooksAtThoseNearby) {
  // Of 400 discs in rings one leaves the polygon, and is laid back.
  const auto looked_at = [](int sides) {
    const auto corner = [&](int k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      return Point{30 * std::cos(angle), 30 * std::sin(angle)};
    };
    std::vector<Shape> walls;
    for (int k = 0; k < sides; ++k) walls.emplace_back(Segment{corner(k), corner(k + 1)});
    const WallStep step{walls, walls, std::vector<ShapeStep>(walls.size())};
    Bodies bodies;
    for (int k = 0; k < 400; ++k) {
      const double distance = 29.4 - 1.1 * (k / 160), angle = 2 * std::numbers::pi * (k % 160 + 0.25) / 160;
      add_body(bodies, distance * std::cos(angle), distance * std::sin(angle), 0.5);
    }
    WallCrossings crossings;
    crossings.begin(bodies, step.before);
    bodies.x[0] += 0.7;
    EXPECT_NEAR(crossings.undo(step, {}, bodies).deepest, 0.6, 0.05) << sides;
    EXPECT_NEAR(std::hypot(bodies.x[0], bodies.z[0]), 29.5, 0.05);
    return crossings.looked_at();
  };
  const auto few = looked_at(100), many = looked_at(10000);
  EXPECT_LT(many, 10 * few);
}

}  // namespace
}  // namespace drumlin::test
