// Walls that move: no grain gets through one, and one that a force moves does not press grains into each
// other.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <utility>

#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/watch.hpp"

namespace drumlin {
using namespace test;
namespace {

/// Numbers in [0, 1) that are the same everywhere.
class Numbers {
 public:
  double next() { return static_cast<double>(engine_()) / 4294967296.0; }

 private:
  std::mt19937 engine_{3};
};

/// What a user gets who asks for nothing of the solver.
TestScene plain(const std::vector<Grain>& discs, double mu) {
  TestScene trial = scene_of(discs);
  trial.solver = SolverSettings{};
  return mu == 0 ? trial : trial.with(Friction{mu, mu}, Spin{});
}

// Walls that a force moves.

struct Pressed {
  int side = 0;   ///< discs along a side of the box
  int walls = 1;  ///< of the four that press
  double mu = 0;
  double wall_mass = 10;
  int steps = 0;
};

/// Discs of 0.8 to 1.2 d, loose at first, pressed together with 10 rho0 g d.
std::vector<HardCheck> pressed(const Pressed& setup) {
  const double h = 0.02, spacing = 1.25, half = setup.side * spacing / 2, pressure = 10;
  std::vector<Grain> discs;
  Numbers numbers;
  for (int row = 0; row < setup.side; ++row)
    for (int k = 0; k < setup.side; ++k) {
      const double x = spacing * (k + 0.5) - half + 0.02 * numbers.next();
      const double z = spacing * (row + 0.5) - half + 0.02 * numbers.next();
      discs.push_back({x, z, 0.8 + 0.4 * numbers.next()});
    }
  TestScene trial = plain(discs, setup.mu).between(box_walls(half)).lasting(setup.steps * h, h);
  const struct {
    const char* name;
    std::array<double, 2> inwards;
  } box[] = {{"top", {0, -1}}, {"left", {1, 0}}, {"right", {-1, 0}}, {"floor", {0, 1}}};
  for (const auto& wall : std::span(box).first(setup.walls))
    trial.moving(wall.name, pushed(wall.inwards, pressure * 2 * half, setup.wall_mass));
  TestRun run(trial);
  double sum = 0, latest = 0;
  int finite = 0;
  for (int step = 0; step < setup.steps; ++step) {
    const double mean = run.step().overlap.mean;
    sum += mean;
    if (2 * step > setup.steps) latest = larger(latest, mean);
    finite += std::isfinite(run.kinetic());
  }
  const std::string why = "what a step leaves must not add up over the steps";
  return {
      at_most("mean overlap of loaded contacts, over all steps", 1e-4, sum / setup.steps, why),
      at_most("the same, worst step of the second half", 1e-4, latest, why + "; the walls' impact is over"),
      at_most("steps with NaN", 0, setup.steps - finite, "none")};
}

// Walls that are moved.

enum class Way { shaken, shaken_askew, turned, rocked };

struct Shaken {
  Way way = Way::shaken;
  int grains = 0;
  double move = 0;  ///< of a wall in a step, at most; d, of which the smallest radius is 0.45
  int steps = 0;
  bool periodic = false;
  double odd = 0;  ///< diameter of one grain; 0: as the others
};

constexpr double half_width = 8, half_height = 12.4, shaking_rate = 0.5, shaking_step = 0.02;

/// Displacement of the box at a time; the angle clockwise.
Pose pose_of(const Shaken& setup, double time) {
  const double rate = 2 * std::numbers::pi * shaking_rate;
  const double reach = setup.move / (rate * shaking_step), swing = std::sin(rate * time);
  const double corner = std::hypot(half_width, half_height);
  switch (setup.way) {
    case Way::shaken:
      return {0, 0, reach * swing};
    case Way::shaken_askew:
      return {0, 0.8 * reach * swing, 0.6 * reach * swing};
    case Way::turned:
      return {setup.move / (corner * shaking_step) * time, 0, 0};
    case Way::rocked:
      return {reach / corner * swing, 0, 0};
  }
  return {};
}

WallMotion motion_of(const Shaken& setup) {
  const double hertz = shaking_rate / time_s, quarter = 1 / (4 * shaking_rate);
  const Pose most = pose_of(setup, quarter);  // of what swings
  if (setup.way == Way::turned)
    return {"box", Rotation{most.angle / quarter / time_s * 60 / (2 * std::numbers::pi), {0, 0}}};
  if (setup.way == Way::rocked)
    return {"box", Rocking{most.angle * 180 / std::numbers::pi, hertz, 0, {0, 0}}};
  return {"box", Oscillation{{most.x, most.z}, hertz, 0}};
}

/// A box, or a floor and a roof in a periodic domain, with grains of 0.9 to 1.1 d. The solver has thirty
/// sweeps.
TestScene filled(const Shaken& setup) {
  std::vector<Grain> discs;
  Numbers numbers;
  double x = -half_width, z = -half_height, row = 0;
  const auto add = [&](double diameter) {
    if (x + 1.05 * diameter > half_width) x = -half_width, z += std::exchange(row, 0);
    discs.push_back({x + 0.525 * diameter, z + 0.525 * diameter, diameter});
    x += 1.05 * diameter, row = std::max(row, 1.05 * diameter);
  };
  for (int k = 0; k < setup.grains; ++k) add(0.9 + 0.2 * numbers.next());
  if (setup.odd > 0) add(setup.odd);
  TestScene trial = plain(discs, 0.4)
                        .between({segment("box", {-half_width, -half_height}, {half_width, -half_height}),
                                  segment("box", {-half_width, half_height}, {half_width, half_height})})
                        .with(Gravity{}, Restitution{0.46, 0.46})
                        .lasting(setup.steps * shaking_step, shaking_step);
  trial.stages[0].motions = {motion_of(setup)};
  if (setup.periodic) {
    trial.periodic_x = PeriodicX{-half_width, half_width};
  } else {
    trial.walls.push_back(segment("box", {-half_width, -half_height}, {-half_width, half_height}));
    trial.walls.push_back(segment("box", {half_width, -half_height}, {half_width, half_height}));
  }
  trial.solver.max_sweeps = 30;
  return trial;
}

/// In a run whose unit of length is the mean diameter of its grains.
int outside(const TestRun& run, const Shaken& setup) {
  const double d = run.scales().length_m * 1e3;
  const Pose back = inverse(pose_of(setup, run.time() * std::sqrt(d)));
  const Bodies& b = run.bodies();
  int count = 0;
  for (std::size_t k = 0; k < b.count(); ++k) {
    const Point at = moved(back, {b.x[k] * d, b.z[k] * d});
    count += !(std::abs(at.z) < half_height && (setup.periodic || std::abs(at.x) < half_width));
  }
  return count;
}

std::vector<HardCheck> shaken(const Shaken& setup) {
  TestRun run(filled(setup));
  int out = 0;
  const Watch watch = run_watched(run, [&] { out = std::max(out, outside(run, setup)); });
  return {at_most("grains outside, worst step", 0, out, "walls hold what is in them"),
          at_most("grains reported lost", 0, watch.steps_lost, "none"),
          at_most("steps with NaN", 0, watch.steps_not_finite, "none")};
}

std::vector<HardCheck> too_far(const Shaken& setup) {
  TestScene still = filled(setup);  // a start would refuse the motion
  still.stages[0].motions.clear();
  TestRun run(filled(setup), Simulation(still).state());
  double found = 0;
  while (!run.finished() && found == 0)
    if (const auto lost = run.step().lost) found = lost->how == LostGrain::How::pushed_too_far ? 1 : -1;
  return {equals("says that a wall moves too far (1), another loss (-1)", 1, found, 0,
                 "a wall that moves by more than a radius can pass a grain unseen")};
}

// Large grains on small ones.

/// In a turning drum at the default solver, whose sweeps do not suffice for masses of 1 to 125,000.
std::vector<HardCheck> pressed_out(int grains, int steps) {
  TestRun run(scene_of(GeneratedGrains{grains, 0.2, 10, CircleRegion{{0, 0}, 129}, TwoSizes{0.95}})
                  .between({drum_wall(130)})
                  .with(Gravity{}, Friction{0.4, 0.4}, Restitution{0.46, 0.46}, Spin{})
                  .lasting(steps * 1e-3 / time_s, 1e-3 / time_s));
  const Watch watch = run_watched(run);
  return {at_most("grains reported lost", 0, watch.steps_lost, "none"),
          at_most("steps with NaN", 0, watch.steps_not_finite, "none")};
}

// A long chain.

TestScene column(int discs, int steps, double h) {
  return plain(column_of(discs), 0.4).between({floor_wall()}).with(Gravity{}).lasting(steps * h, h);
}

std::vector<HardCheck> column_height(int discs, int steps) {
  TestScene trial = column(discs, steps, 0.4);
  trial.solver.max_sweeps = 20000;
  TestRun run(trial);
  double sunk = 0;
  run_watched(run, [&] { sunk = larger(sunk, discs - 0.5 - run.bodies().z.back()); });
  return {at_most("height lost at worst, d", 0.02, sunk,
                  "a step lets discs sink by 1e-3 d on average, the top by twice that; ten times it")};
}

/// The scene that a user would write: discs of 10 mm, a step of 1 ms, and nothing said of the solver.
std::vector<HardCheck> column_default(int discs, int steps) {
  TestRun run(column(discs, steps, 1e-3 / std::sqrt(10e-3 / 9.81)));
  const Watch watch = run_watched(run);
  return {
      at_most("height lost, d", 0.3, discs - 0.5 - run.bodies().z.back(),
              "a step sinks by 1e-3 d on average at most, the projection takes it away; 1e-3 a disc allowed"),
      at_most("largest overlap, d", 1e-2, watch.largest_overlap, "ten times the penetration tolerance"),
      at_most("steps that missed a tolerance", 0, watch.steps_missed, "5000 sweeps suffice")};
}

}  // namespace

std::vector<HardCase> wall_cases() {
  const auto press = [](const std::string& name, const std::string& what, bool fast, const Pressed& setup) {
    return HardCase{name, what, fast, [setup] { return pressed(setup); }};
  };
  const auto shake = [](const std::string& name, const std::string& what, bool fast, const Shaken& setup) {
    return HardCase{name, what, fast, [setup] { return shaken(setup); }};
  };
  return {
      press("pressed-by-one", "a force presses one wall of a box onto 64 discs: no overlap builds up", true,
            {8, 1, 0, 10, 2000}),
      press("pressed-by-four", "forces press all four walls: no overlap builds up", true,
            {8, 4, 0, 10, 2000}),
      press("pressed-by-heavy", "the same with walls as heavy as all discs", true, {8, 4, 0, 50, 2000}),
      press("pressed-by-one-784", "784 discs, one wall, 1e5 steps", false, {28, 1, 0, 10, 100000}),
      press("pressed-by-four-784", "784 discs, four walls, 1e5 steps", false, {28, 4, 0, 10, 100000}),
      press("pressed-with-friction-784", "the same with friction 0.4", false, {28, 4, 0.4, 10, 100000}),
      shake("shaken", "a box whose walls move by 0.41 d a step holds its grains", true,
            {Way::shaken, 300, 0.41, 250}),
      shake("shaken-askew", "the same, shaken along a slope", true, {Way::shaken_askew, 200, 0.41, 300}),
      shake("shaken-periodic", "the same without side walls", true,
            {Way::shaken_askew, 200, 0.41, 300, true}),
      shake("shaken-odd", "the same with one grain of 8 d", true,
            {Way::shaken_askew, 120, 0.41, 300, false, 8}),
      shake("turned", "a box that turns, its corners by 0.41 d a step", true, {Way::turned, 200, 0.41, 300}),
      shake("rocked", "a box that swings, its corners by 0.41 d a step", true, {Way::rocked, 200, 0.41, 300}),
      {"shaken-too-far", "a box whose walls move by 0.6 d a step: the run ends with the reason", true,
       [] {
         return too_far({Way::shaken, 100, 0.6, 100});
       }},
      {"size-ratio-1500", "1500 discs of 0.2 and 10 mm settle in a drum: none is pressed out by a large one",
       true, [] { return pressed_out(1500, 35); }},
      {"column-100-height", "a column of 100, default tolerances, a large step: it keeps its height", true,
       [] { return column_height(100, 200); }},
      {"column-1000-height", "the same with 1000 discs", false, [] { return column_height(1000, 1000); }},
      {"column-default", "1000 discs of 10 mm at 1 ms, every setting its default: they stay", false,
       [] { return column_default(1000, 1000); }},
  };
}

}  // namespace drumlin
