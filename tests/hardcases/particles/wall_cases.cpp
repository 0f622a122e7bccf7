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
#include "tests/hardcases/particles/trial.hpp"

namespace drumlin {
using namespace particles;
namespace {

const double unit_s = std::sqrt(1e-3 / 9.81);  // of a trial: d = 1 mm, 1000 kg/m3
constexpr double mass_unit = 1000 * 1e-6, force_unit = mass_unit * 9.81;

/// Numbers in [0, 1) that are the same everywhere.
class Numbers {
 public:
  double next() { return static_cast<double>(engine_()) / 4294967296.0; }

 private:
  std::mt19937 engine_{3};
};

/// What a user gets who asks for nothing.
Trial with_default_solver() {
  Trial trial;
  trial.scene.solver = SolverSettings{};
  return trial;
}

void rub(Trial& trial, double mu) {
  if (mu == 0) return;
  trial.scene.effects.friction = Friction{mu, mu};
  trial.scene.effects.spin = Spin{};
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
std::vector<HardCheck> pressed(const Pressed& asked) {
  const double h = 0.02, spacing = 1.25, half = asked.side * spacing / 2, pressure = 10;
  Trial trial = with_default_solver();
  Numbers numbers;
  for (int row = 0; row < asked.side; ++row)
    for (int k = 0; k < asked.side; ++k) {
      const double x = spacing * (k + 0.5) - half + 0.02 * numbers.next();
      const double z = spacing * (row + 0.5) - half + 0.02 * numbers.next();
      trial.discs.push_back({x, z, 0.8 + 0.4 * numbers.next()});
    }
  trial.scene.walls = trial_box(half);
  rub(trial, asked.mu);
  trial.add_stage(asked.steps * h, h);
  const struct {
    const char* name;
    std::array<double, 2> inwards;
  } box[] = {{"top", {0, -1}}, {"left", {1, 0}}, {"right", {-1, 0}}, {"floor", {0, 1}}};
  for (const auto& wall : std::span(box).first(asked.walls))
    trial.scene.stages.back().motions.push_back(
        {wall.name,
         ForceControl{wall.inwards, pressure * 2 * half * force_unit, asked.wall_mass * mass_unit, {0, 0}}});
  Simulation simulation = trial.start();
  double sum = 0, latest = 0;
  int finite = 0;
  for (int step = 0; step < asked.steps; ++step) {
    const double mean = simulation.step().overlap.mean;
    sum += mean;
    if (2 * step > asked.steps) latest = larger(latest, mean);
    finite += std::isfinite(kinetic_energy(simulation.state().bodies));
  }
  const std::string why = "what a step leaves must not add up over the steps";
  return {
      at_most("mean overlap of loaded contacts, over all steps", 1e-4, sum / asked.steps, why),
      at_most("the same, worst step of the second half", 1e-4, latest, why + "; the walls' impact is over"),
      at_most("steps with NaN", 0, asked.steps - finite, "none")};
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

/// A box, or a floor and a roof in a periodic domain, with grains of 0.9 to 1.1 d. The solver has thirty
/// sweeps.
Trial filled(const Shaken& asked) {
  Trial trial = with_default_solver();
  Numbers numbers;
  double x = -half_width, z = -half_height, row = 0;
  const auto add = [&](double diameter) {
    if (x + 1.05 * diameter > half_width) x = -half_width, z += std::exchange(row, 0);
    trial.discs.push_back({x + 0.525 * diameter, z + 0.525 * diameter, diameter});
    x += 1.05 * diameter, row = std::max(row, 1.05 * diameter);
  };
  for (int k = 0; k < asked.grains; ++k) add(0.9 + 0.2 * numbers.next());
  if (asked.odd > 0) add(asked.odd);
  trial.scene.walls = {trial_segment("box", -half_width, -half_height, half_width, -half_height),
                       trial_segment("box", -half_width, half_height, half_width, half_height)};
  if (asked.periodic) {
    trial.scene.periodic_x = PeriodicX{-half_width, half_width};
  } else {
    trial.scene.walls.push_back(trial_segment("box", -half_width, -half_height, -half_width, half_height));
    trial.scene.walls.push_back(trial_segment("box", half_width, -half_height, half_width, half_height));
  }
  trial.scene.effects.gravity = Gravity{};
  trial.scene.effects.restitution = Restitution{0.46, 0.46};
  rub(trial, 0.4);
  trial.scene.solver.max_sweeps = 30;
  return trial;
}

/// Displacement of the box at a time; the angle clockwise.
Pose pose_of(const Shaken& asked, double time) {
  const double rate = 2 * std::numbers::pi * shaking_rate;
  const double reach = asked.move / (rate * shaking_step), swing = std::sin(rate * time);
  const double corner = std::hypot(half_width, half_height);
  switch (asked.way) {
    case Way::shaken:
      return {0, 0, reach * swing};
    case Way::shaken_askew:
      return {0, 0.8 * reach * swing, 0.6 * reach * swing};
    case Way::turned:
      return {asked.move / (corner * shaking_step) * time, 0, 0};
    case Way::rocked:
      return {reach / corner * swing, 0, 0};
  }
  return {};
}

WallMotion motion_of(const Shaken& asked) {
  const double hertz = shaking_rate / unit_s, quarter = 1 / (4 * shaking_rate);
  const Pose most = pose_of(asked, quarter);  // of what swings
  if (asked.way == Way::turned)
    return {"box", Rotation{most.angle / quarter / unit_s * 60 / (2 * std::numbers::pi), {0, 0}}};
  if (asked.way == Way::rocked)
    return {"box", Rocking{most.angle * 180 / std::numbers::pi, hertz, 0, {0, 0}}};
  return {"box", Oscillation{{most.x, most.z}, hertz, 0}};
}

int outside(const Bodies& b, const Pose& pose, bool periodic) {
  int count = 0;
  for (std::size_t k = 0; k < b.count(); ++k) {
    const Point at = moved(inverse(pose), {b.x[k], b.z[k]});
    count += !(std::abs(at.z) < half_height && (periodic || std::abs(at.x) < half_width));
  }
  return count;
}

std::vector<HardCheck> shaken(const Shaken& asked) {
  Trial trial = filled(asked);
  trial.add_stage(asked.steps * shaking_step, shaking_step);
  trial.scene.stages.back().motions = {motion_of(asked)};
  Simulation simulation = trial.start();
  int out = 0;
  const Watch watch = run_watched(simulation, [&](const Simulation& s) {
    out = std::max(out, outside(s.state().bodies, pose_of(asked, s.state().time()), asked.periodic));
  });
  return {at_most("grains outside, worst step", 0, out, "walls hold what is in them"),
          at_most("grains reported lost", 0, watch.steps_lost, "none"),
          at_most("steps with NaN", 0, watch.steps_not_finite, "none")};
}

std::vector<HardCheck> too_far(const Shaken& asked) {
  Trial trial = filled(asked);
  trial.add_stage(asked.steps * shaking_step, shaking_step);
  trial.scene.stages.back().motions = {motion_of(asked)};
  Simulation simulation = trial.start();
  double told = 0;
  while (!simulation.finished() && told == 0)
    if (const auto lost = simulation.step().lost) told = lost->how == LostGrain::How::pushed_too_far ? 1 : -1;
  return {equals("says that a wall moves too far (1), another loss (-1)", 1, told, 0,
                 "a wall that moves by more than a radius can pass a grain unseen")};
}

// Large grains on small ones.

/// In a turning drum at the default solver, whose sweeps do not suffice for masses of 1 to 125,000.
std::vector<HardCheck> pressed_out(int grains, int steps) {
  Scene scene;
  scene.title = "hard case";
  scene.grains.density_kg_m3 = 2700;
  scene.grains.source = GeneratedGrains{grains, 0.2, 10, CircleRegion{{0, 0}, 129}, TwoSizes{0.95}};
  scene.walls = {{"drum", ContainerShape{{0, 0}, 130}}};
  scene.effects = {Gravity{}, Friction{0.4, 0.4}, Restitution{0.46, 0.46}, Spin{}};
  scene.output.velocity_window_s = 0;
  Stage stage;
  stage.name = "settle", stage.duration_s = steps * 1e-3, stage.time_step_s = 1e-3;
  scene.stages = {stage};
  Simulation simulation(scene);
  const Watch watch = run_watched(simulation);
  return {at_most("grains reported lost", 0, watch.steps_lost, "none"),
          at_most("steps with NaN", 0, watch.steps_not_finite, "none")};
}

// A long chain.

std::vector<HardCheck> column_height(int discs, int steps) {
  const double h = 0.4;
  Trial trial = with_default_solver();
  for (int k = 0; k < discs; ++k) trial.discs.push_back({0, 0.5 + k});
  trial.scene.walls = {trial_floor()};
  trial.scene.effects.gravity = Gravity{};
  rub(trial, 0.4);
  trial.scene.solver.max_sweeps = 20000;
  trial.add_stage(steps * h, h);
  Simulation simulation = trial.start();
  double sunk = 0;
  run_watched(simulation,
              [&](const Simulation& s) { sunk = larger(sunk, discs - 0.5 - s.state().bodies.z.back()); });
  return {at_most("height lost at worst, d", 0.02, sunk,
                  "a step lets discs sink by 1e-3 d on average, the top by twice that; ten times it")};
}

/// The scene that a user would write: discs of 10 mm, a step of 1 ms, and nothing said of the solver.
std::vector<HardCheck> column_default(int discs, int steps) {
  const double h = 1e-3 / std::sqrt(10e-3 / 9.81);
  Trial trial = with_default_solver();
  for (int k = 0; k < discs; ++k) trial.discs.push_back({0, 0.5 + k});
  trial.scene.walls = {trial_floor()};
  trial.scene.effects.gravity = Gravity{};
  rub(trial, 0.4);
  trial.scene.solver = SolverSettings{};
  trial.add_stage(steps * h, h);
  Simulation simulation = trial.start();
  const Watch watch = run_watched(simulation);
  return {
      at_most("height lost, d", 0.3, discs - 0.5 - simulation.state().bodies.z.back(),
              "a step sinks by 1e-3 d on average at most, the projection takes it away; 1e-3 a disc allowed"),
      at_most("largest overlap, d", 1e-2, watch.largest_overlap, "ten times the penetration tolerance"),
      at_most("steps that missed a tolerance", 0, watch.steps_missed, "5000 sweeps suffice")};
}

}  // namespace

std::vector<HardCase> wall_cases() {
  const auto press = [](const std::string& name, const std::string& what, bool fast, const Pressed& asked) {
    return HardCase{name, what, fast, [asked] { return pressed(asked); }};
  };
  const auto shake = [](const std::string& name, const std::string& what, bool fast, const Shaken& asked) {
    return HardCase{name, what, fast, [asked] { return shaken(asked); }};
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
