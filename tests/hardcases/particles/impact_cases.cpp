// Impacts of one disc, or of a few in a row.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/watch.hpp"

namespace drumlin {
using namespace test;
namespace {

TestScene drop(double height, double e, double duration, double h) {
  return scene_of({{0, 0.5 + height}})
      .between({floor_wall()})
      .with(Gravity{}, Restitution{e, e})
      .lasting(duration, h);
}

std::vector<HardCheck> drop_peaks() {
  const double e = 0.6, height = 4, h = 2e-4;
  TestRun run(drop(height, e, 14, h));
  std::vector<double> peaks;
  double before = height, now = height;
  run_watched(run, [&] {
    const double z = run.bodies().z[0] - 0.5;
    if (now > before && now > z) peaks.push_back(now);
    before = now, now = z;
  });
  peaks.resize(4, std::nan(""));
  std::vector<HardCheck> checks;
  for (int n = 1; n <= 4; ++n)
    checks.push_back(equals("height of peak " + std::to_string(n), height * std::pow(e, 2 * n), peaks[n - 1],
                            5 * h * std::sqrt(2 * height),
                            "the time of an impact is known to a step, its speed to g h: 5 h sqrt(2 g H)"));
  return checks;
}

TestScene row(const std::vector<Grain>& discs, double e, double duration, double h) {
  TestScene trial = scene_of(discs).with(Restitution{e, e}).lasting(duration, h);
  trial.solver.tolerance = 1e-12;
  trial.solver.check_every = 1;
  return trial;
}

/// Newton's cradle of five: with gaps the impacts follow one another, and the last disc leaves with e_4 of
/// the speed; discs that touch follow Newton's law at once.
std::vector<HardCheck> cradle_of_five() {
  std::vector<HardCheck> checks;
  for (const double e : {1.0, 0.9, 0.4}) {
    std::vector<Grain> discs{{-1.3, 0, 1, 1}};
    for (int k = 0; k < 4; ++k) discs.push_back({1.001 * k, 0});
    const std::string suffix = ", e = " + std::to_string(e).substr(0, 3);
    const Bodies end = bodies_at_end(row(discs, e, 0.4, 1e-3));
    checks.push_back(equals("last disc" + suffix, std::pow((1 + e) / 2, 4), end.v_x[4], 1e-10,
                            "each impact passes on (1 + e)/2; residual 1e-12"));
    double momentum = 0;
    for (const double v : end.v_x) momentum += v;
    checks.push_back(equals("momentum" + suffix, 1, momentum, 1e-12, "rounding"));
    for (std::size_t k = 1; k < discs.size(); ++k) discs[k].x = static_cast<double>(k) - 1;
    const Bodies touching = bodies_at_end(row(discs, e, 0.4, 1e-3));
    checks.push_back(equals("striker on four that touch" + suffix, (1 - 4 * e) / 5, touching.v_x[0], 1e-8,
                            "Newton's law for impacts at once"));
    for (int k = 1; k <= 4; ++k)
      checks.push_back(equals(fmt::format("disc {} of four that touch{}", k, suffix), (1 + e) / 5,
                              touching.v_x[k], 1e-8, "Newton's law for impacts at once"));
  }
  return checks;
}

/// Impacts on grains that others are near, and do not touch.
std::vector<HardCheck> near_misses() {
  const double h = 0.0313, speed = 3.2;  // of 10 mm: 1e-3 s, 1 m/s
  const Bodies row_end = bodies_at_end(row({{0, 0, 1, speed}, {1.01, 0}, {2.02, 0}}, 1, 6 * h, h));
  const Bodies end = bodies_at_end(row({{0.51, 0, 1, -speed}, {1.53, -0.15, 1, 0, 3 * speed}}, 0, 2 * h, h)
                                       .between({segment("left", {0, -9}, {0, 9})}));
  const std::string why = "each impact is of two bodies; rounding";
  return {equals("first of a row with gaps of 0.01 d, e = 1", 0, row_end.v_x[0], 1e-9, why),
          equals("second", 0, row_end.v_x[1], 1e-9, why),
          equals("third / speed", 1, row_end.v_x[2] / speed, 1e-9, why),
          equals("speed gained by a disc that passes 0.03 d behind one that a wall stops", 0,
                 std::hypot(end.v_x[1], end.v_z[1] - 3 * speed), 1e-9, "they never touch"),
          equals("speed of the one that was stopped", 0, std::hypot(end.v_x[0], end.v_z[0]), 1e-9, "e = 0")};
}

/// Velocities after a disc without spin has met a floor, without gravity.
Bodies oblique_impact(double v_t, double v_n, double mu, double e) {
  return bodies_at_end(scene_of({{0, 0.55, 1, v_t, -v_n}})
                           .between({floor_wall()})
                           .with(Friction{mu, mu}, Restitution{e, e}, Spin{})
                           .lasting(0.2, 1e-3));
}

std::vector<HardCheck> oblique() {
  const double e = 0.5, mu = 0.3, limit = 3 * mu * (1 + e);
  const Bodies sticks = oblique_impact(0.9 * limit, 1, mu, e), slips = oblique_impact(1.5 * limit, 1, mu, e);
  const std::string why = "one contact is solved exactly";
  return {equals("tangential speed, sticking", 2.0 / 3 * 0.9 * limit, sticks.v_x[0], 1e-8, why),
          equals("speed of the rim, sticking", 0, sticks.v_x[0] - 0.5 * sticks.spin[0], 1e-8, why),
          equals("normal speed, sticking", e, sticks.v_z[0], 1e-9, why),
          equals("tangential speed, slipping", 1.5 * limit - mu * (1 + e), slips.v_x[0], 1e-8, why),
          equals("normal speed, slipping", e, slips.v_z[0], 1e-9, why)};
}

std::vector<HardCheck> billiard() {
  TestScene trial = row({{0.3, 0, 1, 1}}, 1, 30500, 0.1)
                        .between({segment("left", {-2, -5}, {-2, 5}), segment("right", {2, -5}, {2, 5})});
  trial.solver.tolerance = 1e-14;
  TestRun run(trial);
  double velocity = 1;
  int impacts = 0;
  const Watch watch = run_watched(run, [&] {
    const double now = run.bodies().v_x[0];
    impacts += now * velocity < 0;
    velocity = now;
  });
  return {at_least("impacts", 10000, impacts, "a way of 3 d each, at speed 1 for 30500"),
          equals("energy at the end / at the start", 1, 1 + watch.gain, 1e-12, "rounding of 1e4 impacts")};
}

std::vector<HardCheck> shot() {
  const double speed = 100, e = 0.5, radius = 20;
  TestScene trial = scene_of({{0, 0, 1, 60, -80}})
                        .between({drum_wall(radius)})
                        .with(Restitution{e, e})
                        .lasting(0.35, 0.0545);  // 5.45 d per step; one impact
  TestRun run(trial);
  double farthest = 0;
  const Watch watch = run_watched(
      run, [&] { farthest = larger(farthest, std::hypot(run.bodies().x[0], run.bodies().z[0]) + 0.5); });
  const Bodies& end = run.bodies();
  return {at_most("reach in radii of the drum", 1 + 1e-6, farthest / radius,
                  "no passing through the wall; residual 1e-9"),
          equals("speed after the impact", e * speed, std::hypot(end.v_x[0], end.v_z[0]), 1e-6 * speed,
                 "a central impact; residual 1e-9"),
          at_most("steps with NaN", 0, watch.steps_not_finite, "none")};
}

std::vector<HardCheck> fast_passes() {
  // Two discs that pass each other 0.05 d apart at 200 sqrt(g d), from different places within a step.
  double worst = 0;
  for (int k = 0; k < 40; ++k) {
    const Bodies end = bodies_at_end(row({{-20 - 0.25 * k, 0, 1, 200}, {0, 1.05}}, 0.5, 0.4, 0.05));
    for (const double gained : {end.v_z[0], end.v_z[1], end.v_x[1]}) worst = larger(worst, std::abs(gained));
  }
  return {at_most("largest speed gained", 0, worst, "straight paths that do not meet: no contact acts")};
}

std::vector<HardCheck> fast_target() {
  TestRun run(scene_of({{-1, 0, 1, 200}, {0, 0}, {1.5, 0}}).lasting(0.5, 0.05));
  double overlap = 0;
  run_watched(run, [&] {
    const Bodies& b = run.bodies();
    overlap = larger(overlap, larger(b.x[0] + 1 - b.x[1], b.x[1] + 1 - b.x[2]));
  });
  const Bodies& end = run.bodies();
  return {at_most("overlap", 1e-6, overlap, "gaps are closed, not crossed; residual 1e-9"),
          equals("common speed", 200.0 / 3, end.v_x[2], 1e-5, "momentum, e = 0"),
          equals("striker", 200.0 / 3, end.v_x[0], 1e-5, "momentum, e = 0")};
}

}  // namespace

std::vector<HardCase> impact_cases() {
  return {
      {"drop-peaks", "a dropped disc peaks at e^(2n) of its height", true, drop_peaks},
      {"cradle-of-five", "with gaps the last of five leaves with ((1+e)/2)^4; touching ones by Newton's law",
       true, cradle_of_five},
      {"oblique", "an impact slips iff |v_t| > 3 mu (1+e) |v_n|; else v_t' = 2/3 v_t", true, oblique},
      {"billiard", "one disc between walls, e = 1: energy kept to 1e-12 over 1e4 impacts", true, billiard},
      {"shot", "a disc at 100 sqrt(g d) stays in the drum and leaves the wall with e times its speed", true,
       shot},
      {"fast-pass", "discs at 200 sqrt(g d) that pass 0.05 d apart do not feel each other", true,
       fast_passes},
      {"fast-target", "a disc at 200 sqrt(g d) pushes its target onto the next, e = 0: v/3 each", true,
       fast_target},
      {"near-misses", "impacts act on those that touch, not on those that are near", true, near_misses},
  };
}

}  // namespace drumlin
