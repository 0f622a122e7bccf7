// Loads at rest: what contacts must carry.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/watch.hpp"

namespace drumlin {
using namespace test;
namespace {

constexpr double time_step = 0.05;

TestScene resting(const std::vector<Grain>& discs, double mu) {
  TestScene trial = on_floor(discs).with(Friction{mu, mu}, Spin{}).lasting(20 * time_step, time_step);
  trial.solver.max_sweeps = 20000;
  return trial;
}

/// Largest error of the normal forces of a column, in its weight; disc k rests on disc k - 1. Infinite when a
/// contact is missing.
double load_error(TestRun& run) {
  run_watched(run);
  const Bodies& bodies = run.bodies();
  const auto count = static_cast<std::int32_t>(bodies.count());
  std::vector<double> above(count);
  double all = 0;
  for (std::int32_t k = count - 1; k >= 0; --k) above[k] = all += 1 / bodies.inverse_mass[k];
  const Snapshot snapshot = run.take_snapshot();
  if (static_cast<std::int32_t>(snapshot.contacts.size()) != count) return HUGE_VAL;
  double worst = 0;
  for (const SnapshotContact& c : snapshot.contacts) {
    const double load = above[std::max(c.i, std::max(c.j, 0))];
    worst =
        larger(worst, larger(std::abs(c.impulse_n / time_step - load), std::abs(c.impulse_t / time_step)));
  }
  return worst / all;
}

std::vector<HardCheck> column(int count) {
  TestRun run(resting(column_of(count), 0.4));
  const double error = load_error(run);
  return {at_most("error of a force / weight", 1e-5, error,
                  "residual 1e-9 of |q|; an error of q adds up over the column"),
          at_most("speed / (g h)", 1e-5, std::sqrt(2 * run.kinetic() / total_mass(run.bodies())) / time_step,
                  "at rest; as above")};
}

std::vector<HardCheck> mass_ratios() {
  std::vector<HardCheck> checks;
  const TestScene scene = resting(column_of(4), 0.4);
  for (const double ratio : {1e3, 1e6})
    for (const bool heavy_first : {true, false}) {
      SimulationState state = Simulation(scene).state();
      for (int k = heavy_first ? 0 : 1; k < 4; k += 2) state.bodies.inverse_mass[k] /= ratio;
      TestRun run(scene, state);
      checks.push_back(at_most("error of a force / weight, 1:" + std::to_string(static_cast<int>(ratio)) +
                                   (heavy_first ? ", heavy below" : ", light below"),
                               1e-9 * ratio, load_error(run),
                               "residual 1e-9, times the condition of W, which is the ratio"));
    }
  return checks;
}

std::vector<HardCheck> wedge() {
  std::vector<HardCheck> checks;
  for (const double half_deg : {30.0, 45.0}) {
    const double alpha = half_deg * std::numbers::pi / 180, far = 10;
    // Walls at `alpha` to the vertical: the disc touches both with its centre r/sin(alpha) above the corner.
    const double mu = 1.2 * std::tan(alpha) + 0.6;
    TestRun run(scene_of({{0, 0.5 / std::sin(alpha)}})
                    .between({segment("left", {0, 0}, {-far * std::sin(alpha), far * std::cos(alpha)}),
                              segment("right", {0, 0}, {far * std::sin(alpha), far * std::cos(alpha)})})
                    .with(Gravity{}, Friction{mu, mu}, Spin{})
                    .lasting(50 * time_step, time_step));
    run_watched(run);
    double normal = 0;
    for (const SnapshotContact& c : run.take_snapshot().contacts) normal += c.impulse_n / time_step;
    const Bodies& b = run.bodies();
    const std::string suffix = ", half angle " + std::to_string(static_cast<int>(half_deg)) + " deg";
    checks.push_back(
        equals("speed" + suffix, 0, std::hypot(b.v_x[0], b.v_z[0], 0.5 * b.spin[0]), 1e-8, "residual 1e-9"));
    checks.push_back(at_most("sum of normal forces / weight" + suffix, 10, normal / weight,
                             "any value that wedges is a solution; it must stay bounded"));
  }
  return checks;
}

std::vector<HardCheck> crystal() {
  const int across = 16, rows = 12;
  std::vector<Grain> discs;
  for (int row = 0; row < rows; ++row)
    for (int k = 0; k < across - row % 2; ++k)
      discs.push_back({0.5 + k + 0.5 * (row % 2), 0.5 + row * std::sqrt(0.75)});
  TestScene trial = resting(discs, 0.4)
                        .between({floor_wall(), segment("left", {0, 0}, {0, 100}),
                                  segment("right", {across, 0}, {across, 100})});
  trial.solver.tolerance = 1e-7;
  TestRun run(trial);
  const Watch watch = run_watched(run);
  const Bodies& bodies = run.bodies();
  double push_x = 0, push_z = 0;
  for (const SnapshotContact& c : run.take_snapshot().contacts) {
    if (c.j >= 0) continue;
    push_x += (c.normal_x * c.impulse_n + c.normal_z * c.impulse_t) / time_step;
    push_z += (c.normal_z * c.impulse_n - c.normal_x * c.impulse_t) / time_step;
  }
  const double all = total_mass(bodies);
  return {equals("lift of the walls / weight", 1, push_z / all, 1e-3, "residual of a hyperstatic packing"),
          equals("sideways push of the walls / weight", 0, push_x / all, 1e-3, "as above"),
          at_most("rms speed / (g h)", 1e-3, std::sqrt(2 * kinetic_energy(bodies) / all) / time_step,
                  "at rest; forces are not unique and not compared"),
          at_most("overlap", 1e-5, watch.largest_overlap, "discs that touch do not sink")};
}

/// Mean number of loaded contacts of a disc, without discs that fewer than two hold.
double coordination(const Snapshot& snapshot, std::size_t count) {
  double mean = 0;
  for (const SnapshotContact& c : snapshot.contacts)
    mean += c.impulse_n / static_cast<double>(snapshot.contacts.size());
  std::vector<bool> held(count, true);
  for (bool changed = true; changed;) {
    std::vector<int> contacts(count);
    for (const SnapshotContact& c : snapshot.contacts)
      if (c.impulse_n > 1e-3 * mean && held[c.i] && held[c.j]) ++contacts[c.i], ++contacts[c.j];
    changed = false;
    for (std::size_t k = 0; k < count; ++k)
      if (held[k] && contacts[k] < 2) held[k] = false, changed = true;
    const auto loaded = static_cast<double>(std::accumulate(contacts.begin(), contacts.end(), 0));
    if (!changed) return loaded / static_cast<double>(std::count(held.begin(), held.end(), true));
  }
  return 0;
}

/// Discs that a cell presses from all sides, with all defaults of the solver.
std::vector<HardCheck> pressed_with_friction(double mu) {
  constexpr int count = 200;
  constexpr double side = 20;
  TestScene scene = scene_of(GeneratedGrains{count, 0.8, 1.2, RectangleRegion{{0, 0}, {side, side}}});
  scene.with(Friction{mu, mu}, Spin{}).lasting(30, 0.02);
  scene.periodic_x = PeriodicX{0, side};
  scene.periodic_z = PeriodicZ{0, side};
  const CellAxis pressed{pressure_unit, {}};
  scene.stages[0].cell = StageCell{pressed, pressed, {}, 1};
  TestRun run(scene);
  const Watch watch = run_watched(run);
  const double Z = coordination(run.take_snapshot(), count);
  return {at_most("steps that miss a tolerance", 0, watch.steps_missed, "each has a solution"),
          at_least("contacts of a disc", 2.9, Z, "isostatic: 3, less what the threshold of loads leaves out"),
          at_most("contacts of a disc", 3.4, Z, "3 for infinite friction; hardly a contact slides")};
}

}  // namespace

std::vector<HardCase> static_cases() {
  return {
      {"column-100", "contact k of a column carries the weight above", true, [] { return column(100); }},
      {"column-1000", "the same with 1000 discs", false, [] { return column(1000); }},
      {"mass-ratio", "columns of heavy and light discs in turn, 1:1e3 and 1:1e6: the weight above", true,
       mass_ratios},
      {"wedge", "a disc in a wedge of half angle alpha, mu >= tan alpha: at rest, forces bounded", true,
       wedge},
      {"crystal", "a monodisperse crystal at rest (hyperstatic): the walls carry its weight", true, crystal},
      {"pressed-friction-10", "200 discs of friction 10 in a cell under pressure: close to isostatic", false,
       [] { return pressed_with_friction(10); }},
      {"pressed-friction-100", "the same with friction 100", false,
       [] { return pressed_with_friction(100); }},
  };
}

}  // namespace drumlin
