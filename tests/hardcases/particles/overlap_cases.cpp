// Starts that overlap: the projection opens them and gives no energy.
#include <algorithm>
#include <cmath>
#include <optional>

#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/watch.hpp"

namespace drumlin {
using namespace test;
namespace {

double summed_overlap(const Bodies& b) {
  double sum = 0;
  for (std::size_t i = 0; i < b.count(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      sum += larger(0.0, b.radius[i] + b.radius[j] - std::hypot(b.x[i] - b.x[j], b.z[i] - b.z[j]));
  return sum;
}

/// A square lattice of discs at rest, which a start state pushes together: no list of grains may overlap.
struct Squeezed {
  int side = 0;
  double spacing = 0;
  int steps = 0;

  TestScene scene() const {
    std::vector<Grain> discs;
    for (int k = 0; k < side * side; ++k) discs.push_back({double(k % side), 0.5 + k / side});
    TestScene trial = scene_of(discs).with(Friction{0.4, 0.4}, Spin{}).lasting(0.05 * steps, 0.05);
    trial.solver.projection_sweeps = 100;
    return trial;
  }
  SimulationState state(std::size_t walls = 0) const {
    SimulationState state = Simulation(scene()).state();
    for (double& x : state.bodies.x) x *= spacing;
    for (double& z : state.bodies.z) z = 0.5 + (z - 0.5) * spacing;
    state.pose_at_start.resize(walls);
    return state;
  }
};

/// `share` of the overlap may be left at the end.
std::vector<HardCheck> opens_slowly(const Squeezed& squeezed, double share) {
  TestRun run(squeezed.scene(), squeezed.state());
  const double first = summed_overlap(run.bodies());
  double last = first, rise = 0;
  const Watch watch = run_watched(run, [&] {
    const double now = summed_overlap(run.bodies());
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
  const Squeezed squeezed{6, 0.7, 800};
  TestScene trial = squeezed.scene()
                        .between({floor_wall(), segment("left", {-0.5, 0}, {-0.5, 100}),
                                  segment("right", {4, 0}, {4, 100})})
                        .with(Gravity{});
  trial.solver.tolerance = 1e-2;
  trial.solver.max_sweeps = 100;
  trial.solver.projection_share = share;
  TestRun run(trial, squeezed.state(trial.walls.size()));
  const Watch watch = run_watched(run);
  const Bodies& b = run.bodies();
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
       [] {
         return opens_slowly({3, 0.95, 100}, 0.6);
       }},
      {"overlap-30", "the same with an overlap of 30 %", true,
       [] {
         return opens_slowly({6, 0.7, 1500}, 0.05);
       }},
      {"overlap-30-heap", "30 % of overlap between walls, in gravity: it opens, energy stays bounded", true,
       [] { return thirty_percent_in_gravity({}); }},
      {"overlap-30-heap-share", "the same where three fifths of an overlap go in a step", true,
       [] { return thirty_percent_in_gravity(0.6); }},
  };
}

}  // namespace drumlin
