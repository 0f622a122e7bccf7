// Starts that overlap: the projection opens them and gives no energy.
#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/trial.hpp"

namespace drumlin {
using namespace particles;
namespace {

double summed_overlap(const Bodies& b) {
  double sum = 0;
  for (std::size_t i = 0; i < b.count(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      sum += larger(0.0, b.radius[i] + b.radius[j] - std::hypot(b.x[i] - b.x[j], b.z[i] - b.z[j]));
  return sum;
}

/// A square lattice of discs at rest, `spacing` apart.
Trial squeezed(int side, double spacing, int steps) {
  Trial trial;
  for (int k = 0; k < side * side; ++k)
    trial.discs.push_back({spacing * (k % side), 0.5 + spacing * (k / side)});
  trial.scene.effects.friction = Friction{0.4, 0.4};
  trial.scene.effects.spin = Spin{};
  trial.scene.solver.projection_sweeps = 100;
  trial.add_stage(0.05 * steps, 0.05);
  return trial;
}

/// `share` of the overlap may be left at the end.
std::vector<HardCheck> opens_slowly(const Trial& trial, double share) {
  Simulation simulation = trial.start();
  const double first = summed_overlap(simulation.state().bodies);
  double last = first, rise = 0;
  const Watch watch = run_watched(simulation, [&](const Simulation& s) {
    const double now = summed_overlap(s.state().bodies);
    rise = larger(rise, now - last);
    last = now;
  });
  return {
      at_most("largest rise of the summed overlap / first", 1e-9, rise / first, "it must fall; rounding"),
      at_most("largest kinetic energy", 1e-20, watch.largest_kinetic, "positions move, velocities do not"),
      at_most("overlap at the end / first", share, last / first,
              "at most 2e-3 d and a fifth of it go in a step"),
      at_most("steps with NaN", 0, watch.steps_not_finite, "none")};
}

/// `share`: of an overlap, taken off per step.
std::vector<HardCheck> thirty_percent_in_gravity(std::optional<double> share) {
  Trial trial = squeezed(6, 0.7, 800);
  trial.scene.walls = {trial_floor(), trial_segment("left", -0.5, 0, -0.5, 100),
                       trial_segment("right", 4, 0, 4, 100)};
  trial.scene.effects.gravity = Gravity{};
  trial.scene.solver.tolerance = 1e-2;
  trial.scene.solver.max_sweeps = 100;
  trial.scene.solver.projection_share = share;
  Simulation simulation = trial.start();
  const Watch watch = run_watched(simulation);
  const Bodies& b = simulation.state().bodies;
  int outside = 0;
  for (std::size_t k = 0; k < b.count(); ++k) outside += b.x[k] < -0.5 || b.x[k] > 4 || b.z[k] < 0;
  const double pairs = 60;  // neighbours at the start
  return {
      at_most("largest kinetic energy / weight and d", 0.02, watch.largest_kinetic / total_mass(b),
              "the heap is lifted by at most 2e-3 d per step of 0.05: (0.04)^2/2 each, if all of it moved; "
              "20 times that for falls into gaps of 0.02 d"),
      at_most("mean overlap at the end", 0.01, summed_overlap(b) / pairs, "from 0.3 d"),
      at_most("discs outside", 0, outside, "none is lost"),
      at_most("steps with NaN", 0, watch.steps_not_finite, "none")};
}

}  // namespace

std::vector<HardCase> overlap_cases() {
  return {
      {"overlap-5", "an overlapped start opens monotonically and gives no kinetic energy", true,
       [] { return opens_slowly(squeezed(3, 0.95, 100), 0.6); }},
      {"overlap-30", "the same with an overlap of 30 %", true,
       [] { return opens_slowly(squeezed(6, 0.7, 1500), 0.05); }},
      {"overlap-30-heap", "30 % of overlap between walls, in gravity: it opens, energy stays bounded", true,
       [] { return thirty_percent_in_gravity({}); }},
      {"overlap-30-heap-share", "the same where three fifths of an overlap go in a step", true,
       [] { return thirty_percent_in_gravity(0.6); }},
  };
}

}  // namespace drumlin
