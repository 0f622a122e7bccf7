// What must not change the answer, and how it converges.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/trial.hpp"

namespace drumlin {
using namespace particles;
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
  Trial trial;
  trial.discs = {{swing * std::sin(start), -swing * std::cos(start)}};
  trial.scene.walls = {trial_container(radius)};
  trial.scene.effects = {Gravity{}, Friction{1, 1}, std::nullopt, Spin{}};
  trial.add_stage(time, h);
  const Bodies end = end_of(trial);
  return std::atan2(end.x[0], -end.z[0]) - pendulum_angle(start, swing, time);
}

double fall_error(double h) {
  Trial trial;
  trial.discs = {{0, 3}};
  trial.scene.effects.gravity = Gravity{};
  trial.add_stage(1, h);
  return end_of(trial).z[0] - 2.5;
}

std::vector<HardCheck> refinement() {
  return {
      equals("error of a free fall at h = 0.02", 0, fall_error(0.02), 1e-12, "a parabola is exact; rounding"),
      equals("order, rolling in a circle", 2, std::log2(pendulum_error(0.02) / pendulum_error(0.01)), 0.1,
             "next order at h = 0.02"),
      at_most("error of the angle at h = 0.01", 1e-4, std::abs(pendulum_error(0.01)),
              "about (h omega)^2, omega^2 = 2 g / (3 (R - r))")};
}

Trial heap() {
  Trial trial;
  for (int k = 0; k < 9; ++k)
    trial.discs.push_back({1.01 * (k % 3) + 0.3 * (k / 3), 0.5 + 1.02 * (k / 3), 1, 0.1 * k, -0.3});
  trial.scene.walls = {trial_segment("floor", -20, 0, 20, 0)};
  trial.scene.effects = {Gravity{}, Friction{0.3, 0.3}, std::nullopt, Spin{}};
  trial.scene.solver.max_sweeps = 20000;
  trial.add_stage(0.5, 0.01);
  return trial;
}

std::vector<HardCheck> rotated_frame() {
  const double c = std::cos(std::numbers::pi / 6), s = std::sin(std::numbers::pi / 6);
  Trial other = heap();
  for (TrialDisc& d : other.discs)
    d = {c * d.x - s * d.z, s * d.x + c * d.z, d.diameter, c * d.v_x - s * d.v_z, s * d.v_x + c * d.v_z};
  other.scene.walls = {trial_segment("floor", -20 * c, -20 * s, 20 * c, 20 * s)};
  other.scene.effects.gravity->direction_deg = -60;
  const Bodies a = end_of(heap()), b = end_of(other);
  double place = 0, spin = 0;
  for (std::size_t k = 0; k < a.count(); ++k) {
    place = larger(place, std::hypot(b.x[k] - c * a.x[k] + s * a.z[k], b.z[k] - s * a.x[k] - c * a.z[k]));
    spin = larger(spin, std::abs(a.spin[k] - b.spin[k]));
  }
  return {at_most("largest difference of a position", 1e-6, place, "residual 1e-9 over 50 steps"),
          at_most("largest difference of a spin", 1e-5, spin, "residual 1e-9 over 50 steps")};
}

std::vector<HardCheck> galilean_shift() {
  Trial trial;
  for (int k = 0; k < 12; ++k)
    trial.discs.push_back({1.01 * (k % 4), 1.02 * (k / 4), 1, 0.3 * (k % 3) - 0.3, -0.2 * (k / 4)});
  trial.scene.effects.friction = Friction{0.3, 0.3};
  trial.scene.effects.restitution = Restitution{0.5, 0.5};
  trial.scene.effects.spin = Spin{};
  trial.add_stage(1, 0.01);
  Trial moving = trial;
  for (TrialDisc& d : moving.discs) d.v_x += 5, d.v_z -= 3;
  const Bodies a = end_of(trial), b = end_of(moving);
  double place = 0, spin = 0;
  for (std::size_t k = 0; k < a.count(); ++k) {
    place = larger(place, std::hypot(b.x[k] - a.x[k] - 5, b.z[k] - a.z[k] + 3));
    spin = larger(spin, std::abs(a.spin[k] - b.spin[k]));
  }
  return {at_most("largest difference of a position", 1e-6, place, "residual 1e-9 over 100 steps"),
          at_most("largest difference of a spin", 1e-5, spin, "residual 1e-9 over 100 steps")};
}

/// Contacts that the solver saw, summed over all steps.
long contacts_of(Simulation& simulation) {
  long sum = 0;
  while (!simulation.finished()) sum += simulation.step().contacts;
  return sum;
}

std::vector<HardCheck> stray_grain() {
  Trial with = heap();
  with.discs.push_back({9e5, 9e5, 1.2, 3, -2});  // last: the heap keeps its numbers
  Simulation alone = heap().start(), beside = with.start();
  const long contacts = contacts_of(alone), contacts_beside = contacts_of(beside);
  const Bodies &a = alone.state().bodies, &b = beside.state().bodies;
  double place = 0;
  for (std::size_t k = 0; k < a.count(); ++k)
    place = larger(place, std::hypot(b.x[k] - a.x[k], b.z[k] - a.z[k]));
  return {equals("pairs that the solver saw more or less", 0, static_cast<double>(contacts_beside - contacts),
                 0, "the stray disc meets nothing"),
          at_most("largest difference of a position in the heap", 1e-6, place, "residual 1e-9 over 50 steps"),
          equals("fall of the stray disc", -2 * 0.5 - 0.125, b.z.back() - 9e5, 3e-3, "h t g / 2 = 0.0025")};
}

/// A drum of many discs that falls and begins to turn.
Trial drum() {
  Trial trial;
  for (int i = -20; i <= 20; ++i)
    for (int k = -20; k <= 20; ++k)
      if (std::hypot(i, k) < 18)
        trial.discs.push_back({1.04 * i + 0.01 * (k % 3), 1.04 * k, 0.9 + 0.02 * ((i * i + 3 * k * k) % 6)});
  trial.scene.walls = {trial_container(20)};
  trial.scene.effects = {Gravity{}, Friction{0.4, 0.9}, Restitution{0.46, 0.46}, Spin{}};
  trial.scene.solver.tolerance = 1e-2;
  trial.scene.solver.max_sweeps = 50;
  trial.add_stage(100 * 0.0545, 0.0545);
  trial.turn("drum", 0.05);
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
  Simulation one = drum().start(1);
  run_watched(one);
  for (const int count : {2, 4}) {
    Simulation many = drum().start(count);
    run_watched(many);
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
