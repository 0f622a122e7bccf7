// Motions in which nothing is lost: over joints of walls, past each other, in bounces, round a smooth drum,
// and many impacts within a step. Times and speeds are those of discs of 10 mm at steps of 1 ms.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/watch.hpp"

namespace drumlin {
using namespace test;
namespace {

const double millisecond = 1e-3 / std::sqrt(1e-2 / 9.81), metre_per_second = 1 / std::sqrt(1e-2 * 9.81);

TestScene bouncing(const std::vector<Grain>& discs, double e) {
  return on_floor(discs).with(Restitution{e, e});
}

/// A floor of segments that meet at these abscissae.
std::vector<Wall> joined_floor(const std::vector<double>& joints) {
  std::vector<Wall> walls;
  for (std::size_t k = 0; k + 1 < joints.size(); ++k)
    walls.push_back(segment("floor" + std::to_string(k), {joints[k], 0}, {joints[k + 1], 0}));
  return walls;
}

std::vector<HardCheck> flat_joints() {
  std::vector<HardCheck> checks;
  for (const double speed : {1.0, 20.0})
    for (const double e : {0.0, 1.0}) {
      std::vector<double> joints{-10, 0.2};
      for (int k = 1; k < 23; ++k) joints.push_back(joints.back() + 1.3 * speed);
      joints.push_back(joints.back() + 1000);
      const Bodies end = bodies_at_end(bouncing({{0, 0.5, 1, speed * metre_per_second}}, e)
                                           .between(joined_floor(joints))
                                           .lasting(400 * millisecond, millisecond));
      const std::string at =
          std::to_string(static_cast<int>(speed)) + " m/s, e = " + std::to_string(static_cast<int>(e));
      checks.push_back(
          equals("speed along, " + at, speed * metre_per_second, end.v_x[0], 1e-9, "a flat floor"));
      checks.push_back(equals("speed across, " + at, 0, end.v_z[0], 1e-7, "a flat floor; residual 1e-9"));
    }
  return checks;
}

std::vector<HardCheck> concave_joint() {
  const double speed = metre_per_second, angle = 0.2;
  const Bodies end = bodies_at_end(
      scene_of({{-0.5, 0.5, 1, speed}})
          .between({segment("floor", {-10, 0}, {0.2, 0}),
                    segment("slope", {0.2, 0}, {0.2 + 200 * std::cos(angle), 200 * std::sin(angle)})})
          .lasting(100 * millisecond, millisecond));
  return {equals("speed up the slope", speed * std::cos(angle), std::hypot(end.v_x[0], end.v_z[0]),
                 1e-6 * speed, "the part across the slope is lost once; residual 1e-9"),
          equals("its angle", angle, std::atan2(end.v_z[0], end.v_x[0]), 1e-6, "along the slope")};
}

std::vector<HardCheck> close_passes() {
  double worst = 0;
  for (int k = 0; k <= 40; ++k) {
    const double way = 0.05 + 0.01 * k, speed = way / 2 / millisecond;
    const Bodies end = bodies_at_end(scene_of({{-2.03, 0, 1, speed}, {2, 1.01, 1, -speed}})
                                         .with(Restitution{1, 1})
                                         .lasting(80 * millisecond / way, millisecond));
    for (const double v : {end.v_z[0], end.v_z[1], end.v_x[0] - speed, end.v_x[1] + speed})
      worst = larger(worst, std::abs(v));
  }
  return {at_most("largest speed gained", 1e-12, worst,
                  "straight paths that do not meet: no contact acts; rounding")};
}

std::vector<HardCheck> slow_along_floor() {
  std::vector<HardCheck> checks;
  const TestScene wall = bouncing({{0, 0.5, 1, 0.015 * metre_per_second}}, 1)
                             .between({floor_wall(), segment("upright", {1, 0}, {1, 5})})
                             .lasting(600 * millisecond, millisecond);
  checks.push_back(equals("against an upright wall", -0.015 * metre_per_second, bodies_at_end(wall).v_x[0],
                          1e-9, "gravity has no part along this normal; residual 1e-9"));
  const double v = 0.009 * metre_per_second;
  const Bodies end =
      bodies_at_end(bouncing({{0, 0.5, 1, v}, {1.1, 0.5, 1, -v}}, 1).lasting(300 * millisecond, millisecond));
  checks.push_back(equals("first of two", -v, end.v_x[0], 1e-9, "equal discs exchange velocities"));
  checks.push_back(equals("second of two", v, end.v_x[1], 1e-9, "equal discs exchange velocities"));
  return checks;
}

std::vector<HardCheck> bounces() {
  const double height = 10;
  TestRun run(bouncing({{0, 0.5 + height}}, 1).lasting(100 * std::sqrt(2 * height), millisecond));
  double lowest_peak = height, before = height, now = height;
  run_watched(run, [&] {
    const double z = run.bodies().z[0] - 0.5;
    if (now > before && now > z) lowest_peak = std::min(lowest_peak, now);
    before = now, now = z;
  });
  const double e = 0.8, rest = std::sqrt(2 * height) * (1 + e) / (1 - e);
  TestRun settles(bouncing({{0, 0.5 + height}}, e).lasting(1.1 * rest, millisecond));
  double last = 0, jitter = 0;
  run_watched(settles, [&] {
    const double speed = std::abs(settles.bodies().v_z[0]);
    if (speed > 1e-6) last = settles.time();
    if (settles.time() > 1.01 * rest) jitter = larger(jitter, speed);
  });
  return {equals("lowest of 50 peaks, e = 1", height, lowest_peak, 1e-3 * height,
                 "0.1 %; a peak may lie half a step from the end of one: 1e-4"),
          equals("time of rest, e = 0.8", rest, last, 1e-3 * rest, "0.1 %"),
          at_most("speed afterwards", 1e-9, jitter, "the residual asked of the solver"),
          equals("height at the end", 0.5, settles.bodies().z[0], 1e-6, "overlap is projected away")};
}

std::vector<HardCheck> slider() {
  const double speed = metre_per_second;
  const Bodies end = bodies_at_end(
      scene_of({{0, -9.5, 1, speed}}).between({drum_wall(10)}).lasting(10000 * millisecond, millisecond));
  return {equals("speed after 10 s, a way of 1000 d", speed, std::hypot(end.v_x[0], end.v_z[0]), 0.01 * speed,
                 "a smooth drum does no work: 1 %")};
}

std::vector<HardCheck> rolling_pendulum() {
  const double angle = 0.5, path = 9.5;
  TestRun run(scene_of({{path * std::sin(angle), -path * std::cos(angle)}})
                  .between({drum_wall(10)})
                  .with(Gravity{}, Friction{1, 1}, Spin{})
                  .lasting(20000 * millisecond, millisecond));
  double farthest = 0;
  const double last = 18000 * millisecond;
  run_watched(run, [&] {
    const auto& b = run.bodies();
    if (run.time() > last) farthest = larger(farthest, std::abs(std::atan2(b.x[0], -b.z[0])));
  });
  return {equals("amplitude after 18 s", angle, farthest, 0.01 * angle, "rolling loses nothing: 1 %")};
}

/// Discs in hexagons with a gap in a closed box, with random velocities.
TestScene hexagons(double gap, double thermal_speed) {
  std::vector<Grain> discs;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0, 1);  // a width of 0 it does not take
  const auto component = [&] { return thermal_speed * normal(random); };
  const double apart = 1 + gap;
  for (int row = 0; row < 10; ++row)
    for (int k = 0; k < 10 - row % 2; ++k)
      discs.push_back(
          {apart * (k + 0.5 * (row % 2)), apart * row * std::sqrt(3.0) / 2, 1, component(), component()});
  const double low = -0.5 - gap, right = 9 * apart + 0.5 + gap,
               top = 9 * apart * std::sqrt(3.0) / 2 + 0.5 + gap;
  return scene_of(discs)
      .between({segment("floor", {low, low}, {right, low}), segment("top", {low, top}, {right, top}),
                segment("left", {low, low}, {low, top}), segment("right", {right, low}, {right, top})})
      .with(Restitution{1, 1});
}

std::vector<HardCheck> dense_elastic() {
  std::vector<HardCheck> checks;
  for (const double gap : {0.01, 0.001}) {
    TestRun run(hexagons(gap, 0.1 * metre_per_second).lasting(50 * millisecond, millisecond));
    const Watch watch = run_watched(run);
    const std::string at = ", gaps of " + std::to_string(gap).substr(0, 5) + " d";
    checks.push_back(equals("energy at the end / at the start" + at, 1, 1 + watch.gain, 1e-9,
                            "elastic impacts; rounding"));
    checks.push_back(at_most("impacts not resolved" + at, 0, watch.impacts_unresolved, "each has its time"));
  }
  TestRun run(
      hexagons(0.12, 2.5 * metre_per_second).with(Restitution{0, 0}).lasting(50 * millisecond, millisecond));
  checks.push_back(at_most("impacts not resolved, e = 0, a quarter of a diameter a step", 0,
                           run_watched(run).impacts_unresolved, "the contact problem takes the same speed"));
  return checks;
}

std::vector<HardCheck> shaken_ledger() {
  std::vector<HardCheck> checks;
  for (const double step : {0.5, 0.25}) {
    TestScene trial = hexagons(0.05, 0)
                          .with(Restitution{0.3, 0.3}, Gravity{})
                          .lasting(1000 * millisecond, step * millisecond);
    trial.walls.erase(trial.walls.begin() + 1);  // open above
    trial.output.energy_ledger = true;
    for (const char* wall : {"floor", "left", "right"})
      trial.moving(wall, Oscillation{{0, 0.2}, 20 * std::sqrt(1e-2 / 9.81) / time_s, 0});
    const EnergyLedger ledger = *EndedRun(trial).state().energy;
    const std::string at = ", h = " + std::to_string(step).substr(0, 4) + " ms";
    checks.push_back(equals("time integration / work of the walls" + at, 0,
                            ledger.time_integration / ledger.walls, 0.02,
                            "both sides of an impact are booked as one"));
    checks.push_back(equals("error of the ledger / turnover" + at, 0, closing_error(ledger) / ledger.turnover,
                            1e-10, "an identity"));
  }
  return checks;
}

}  // namespace

std::vector<HardCase> smooth_cases() {
  return {
      {"flat-joints", "a disc slides over joints of a flat floor as over one segment", true, flat_joints},
      {"concave-joint", "a disc that slides up a slope, e = 0, keeps cos(angle) of its speed", true,
       concave_joint},
      {"close-pass", "discs that pass each other 0.01 d apart do not feel each other", true, close_passes},
      {"slow-along-floor", "slow impacts along a floor, e = 1: velocities are reversed or exchanged", true,
       slow_along_floor},
      {"bounces", "e = 1 peaks at its height; e = 0.8 rests at sqrt(2 H/g) (1+e)/(1-e)", true, bounces},
      {"smooth-drum", "a disc slides round a smooth drum without loss", true, slider},
      {"rolling-pendulum", "a disc that rolls in a drum keeps its amplitude", true, rolling_pendulum},
      {"dense-elastic", "elastic discs with gaps of 0.01 and 0.001 d keep their energy", true, dense_elastic},
      {"shaken-ledger", "energy that impacts take in a shaken box is booked as theirs", true, shaken_ledger},
  };
}

}  // namespace drumlin
