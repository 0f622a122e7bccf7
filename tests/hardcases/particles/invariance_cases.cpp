// What must not change the answer, and how it converges.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/watch.hpp"

namespace drumlin {
using namespace test;
namespace {

/// Angle after `time` of a disc that rolls inside a circle of radius R from rest: phi'' = -(2/3) g sin(phi) /
/// (R - r). Runge-Kutta of fourth order in steps of 1e-4, exact to 1e-12 here.
double pendulum_angle(double phi, double swing, double time) {
  const auto acceleration = [swing](double angle) { return -2.0 / 3 * std::sin(angle) / swing; };
  const int steps = static_cast<int>(std::lround(time / 1e-4));
  const double h = time / steps;
  double v = 0;
  for (int k = 0; k < steps; ++k) {
    const double a1 = acceleration(phi), v2 = v + h / 2 * a1, a2 = acceleration(phi + h / 2 * v);
    const double v3 = v + h / 2 * a2, a3 = acceleration(phi + h / 2 * v2), v4 = v + h * a3;
    const double a4 = acceleration(phi + h * v3);
    phi += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
  return phi;
}

double pendulum_error(double h) {
  const double radius = 10, swing = radius - 0.5, start = 0.5, time = 10;
  const Bodies end = bodies_at_end(scene_of({{swing * std::sin(start), -swing * std::cos(start)}})
                                       .between({drum_wall(radius)})
                                       .with(Gravity{}, Friction{1, 1}, Spin{})
                                       .lasting(time, h));
  return std::atan2(end.x[0], -end.z[0]) - pendulum_angle(start, swing, time);
}

double fall_error(double h) {
  return bodies_at_end(scene_of({{0, 3}}).with(Gravity{}).lasting(1, h)).z[0] - 2.5;
}

std::vector<HardCheck> refinement() {
  return {
      equals("error of a free fall at h = 0.02", 0, fall_error(0.02), 1e-12, "a parabola is exact; rounding"),
      equals("order, rolling in a circle", 2, std::log2(pendulum_error(0.02) / pendulum_error(0.01)), 0.1,
             "next order at h = 0.02"),
      at_most("error of the angle at h = 0.01", 1e-4, std::abs(pendulum_error(0.01)),
              "about (h omega)^2, omega^2 = 2 g / (3 (R - r))")};
}

/// Of the bodies that `a` has, the first of `b`, which stand `where` those of `a` do.
template <class Where>
std::vector<HardCheck> same_bodies(const Bodies& a, const Bodies& b, Where where) {
  double place = 0, spin = 0;
  for (std::size_t k = 0; k < a.count(); ++k) {
    const Point at = where(Point{a.x[k], a.z[k]});
    place = larger(place, std::hypot(b.x[k] - at.x, b.z[k] - at.z));
    spin = larger(spin, std::abs(a.spin[k] - b.spin[k]));
  }
  return {at_most("largest difference of a position", 1e-6, place, "residual 1e-9 over 50 or 100 steps"),
          at_most("largest difference of a spin", 1e-5, spin, "residual 1e-9 over 50 or 100 steps")};
}

std::vector<Grain> nine_discs() {
  std::vector<Grain> discs;
  for (int k = 0; k < 9; ++k)
    discs.push_back({1.01 * (k % 3) + 0.3 * (k / 3), 0.5 + 1.02 * (k / 3), 1, 0.1 * k, -0.3});
  return discs;
}

TestScene heap(const std::vector<Grain>& discs) {
  TestScene trial = scene_of(discs)
                        .between({floor_wall(20)})
                        .with(Gravity{}, Friction{0.3, 0.3}, Spin{})
                        .lasting(0.5, 0.01);
  trial.solver.max_sweeps = 20000;
  return trial;
}

std::vector<HardCheck> rotated_frame() {
  const Pose turn{-std::numbers::pi / 6, 0, 0};
  const auto turned = [&](Point p) { return moved(turn, p); };
  std::vector<Grain> discs = nine_discs();
  for (Grain& d : discs) {
    const Point at = turned({d.x, d.z}), v = turned({d.v_x, d.v_z});
    d = {at.x, at.z, d.diameter, v.x, v.z};
  }
  const Point left = turned({-20, 0}), right = turned({20, 0});
  const TestScene other =
      heap(discs).between({segment("floor", {left.x, left.z}, {right.x, right.z})}).with(Gravity{9.81, -60});
  return same_bodies(bodies_at_end(heap(nine_discs())), bodies_at_end(other), turned);
}

std::vector<HardCheck> galilean_shift() {
  const auto end = [](double v_x, double v_z) {
    std::vector<Grain> discs;
    for (int k = 0; k < 12; ++k)
      discs.push_back({1.01 * (k % 4), 1.02 * (k / 4), 1, 0.3 * (k % 3) - 0.3 + v_x, -0.2 * (k / 4) + v_z});
    return bodies_at_end(
        scene_of(discs).with(Friction{0.3, 0.3}, Restitution{0.5, 0.5}, Spin{}).lasting(1, 0.01));
  };
  return same_bodies(end(0, 0), end(5, -3), [](Point p) { return Point{p.x + 5, p.z - 3}; });
}

std::vector<HardCheck> stray_grain() {
  std::vector<Grain> discs = nine_discs();
  TestRun alone(heap(discs));
  discs.push_back({9e5, 9e5, 1, 3, -2});  // last: the heap keeps its numbers
  TestRun beside(heap(discs));
  const std::int64_t more = run_watched(beside).contacts - run_watched(alone).contacts;
  auto checks = same_bodies(alone.bodies(), beside.bodies(), [](Point p) { return p; });
  checks.push_back(equals("pairs that the solver saw more or less", 0, static_cast<double>(more), 0,
                          "the stray disc meets nothing"));
  checks.push_back(equals("fall of the stray disc", -2 * 0.5 - 0.125, beside.bodies().z.back() - 9e5, 3e-3,
                          "h t g / 2 = 0.0025"));
  return checks;
}

/// A drum of many discs that falls and begins to turn.
TestScene drum() {
  std::vector<Grain> discs;
  for (int i = -20; i <= 20; ++i)
    for (int k = -20; k <= 20; ++k)
      if (std::hypot(i, k) < 18)
        discs.push_back({1.04 * i + 0.01 * (k % 3), 1.04 * k, 0.9 + 0.02 * ((i * i + 3 * k * k) % 6)});
  TestScene trial = scene_of(discs)
                        .between({drum_wall(20)})
                        .with(Gravity{}, Friction{0.4, 0.9}, Restitution{0.46, 0.46}, Spin{})
                        .lasting(100 * 0.0545, 0.0545)
                        .moving("drum", turning(0.05));
  trial.solver.tolerance = 1e-2;
  trial.solver.max_sweeps = 50;
  return trial;
}

int differing(const SimulationState& a, const SimulationState& b) {
  int count = 0;
  const auto compare = [&count](const std::vector<double>& one, const std::vector<double>& other) {
    count += one.size() != other.size();
    for (std::size_t k = 0; k < std::min(one.size(), other.size()); ++k) count += one[k] != other[k];
  };
  compare(a.bodies.x, b.bodies.x), compare(a.bodies.z, b.bodies.z);
  compare(a.bodies.v_x, b.bodies.v_x), compare(a.bodies.v_z, b.bodies.v_z);
  compare(a.bodies.spin, b.bodies.spin);
  compare(a.memory.impulse, b.memory.impulse);
  return count;
}

std::vector<HardCheck> threads() {
  std::vector<HardCheck> checks;
  const EndedRun one(drum());
  for (const int count : {2, 4}) {
    const EndedRun many(drum(), count);
    checks.push_back(equals("numbers that differ, 1 against " + std::to_string(count) + " threads", 0,
                            differing(one.state(), many.state()), 0, "the same bytes"));
  }
  return checks;
}

}  // namespace

std::vector<HardCase> invariance_cases() {
  return {
      {"step-refinement", "free fall is exact; the error of a disc that rolls falls with the step, order 2",
       true, refinement},
      {"rotated-frame", "a heap and gravity turned by 30 degrees: the same answer", true, rotated_frame},
      {"galilean-shift", "twelve discs that all move by more: the same answer", true, galilean_shift},
      {"stray-grain", "a heap, and one disc 1e6 d away: nothing changes", true, stray_grain},
      {"threads", "1, 2 and 4 threads: the same bytes", true, threads},
  };
}

}  // namespace drumlin
