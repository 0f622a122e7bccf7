// Loads at rest: what contacts must carry.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/trial.hpp"

namespace drumlin {
namespace {

constexpr double h = 0.05;

Trial resting(std::vector<TrialDisc> discs, double mu) {
  Trial trial;
  trial.discs = std::move(discs);
  trial.scene.walls = {trial_floor()};
  trial.scene.effects = {particles::Gravity{}, particles::Friction{mu, mu}, std::nullopt, particles::Spin{}};
  trial.scene.solver.max_sweeps = 20000;
  trial.add_stage(20 * h, h);
  return trial;
}

/// Largest error of the normal forces of a column, in its weight; disc k rests on disc k - 1. Infinite when a
/// contact is missing.
double load_error(particles::Simulation& simulation) {
  run_watched(simulation);
  const particles::Bodies& bodies = simulation.state().bodies;
  const auto count = static_cast<std::int32_t>(bodies.count());
  std::vector<double> above(count);
  double weight = 0;
  for (std::int32_t k = count - 1; k >= 0; --k) above[k] = weight += 1 / bodies.inverse_mass[k];
  const particles::Snapshot snapshot = simulation.take_snapshot();
  if (static_cast<std::int32_t>(snapshot.contacts.size()) != count) return HUGE_VAL;
  double worst = 0;
  for (const particles::SnapshotContact& c : snapshot.contacts) {
    const double load = above[std::max(c.i, std::max(c.j, 0))];
    worst = larger(worst, larger(std::abs(c.impulse_n / h - load), std::abs(c.impulse_t / h)));
  }
  return worst / weight;
}

std::vector<HardCheck> column(int count, const std::string& solver) {
  std::vector<TrialDisc> discs;
  for (int k = 0; k < count; ++k) discs.push_back({0, 0.5 + k});
  Trial trial = resting(discs, 0.4);
  trial.scene.solver.name = solver;
  particles::Simulation simulation = trial.start();
  const double error = load_error(simulation);
  return {at_most("error of a force / weight", 1e-5, error,
                  "residual 1e-9 of |q|; an error of q adds up over the column"),
          at_most("speed / (g h)", 1e-5,
                  std::sqrt(2 * kinetic_energy(simulation.state().bodies) /
                            total_mass(simulation.state().bodies)) /
                      h,
                  "at rest; as above")};
}

std::vector<HardCheck> mass_ratios(const std::string& solver) {
  std::vector<HardCheck> checks;
  const double light = particles::mass_of_disc(0.5);
  for (const double ratio : {1e3, 1e6})
    for (const bool heavy_first : {true, false}) {
      std::vector<TrialDisc> discs;
      for (int k = 0; k < 4; ++k)
        discs.push_back({0, 0.5 + k, 1, 0, 0, 0, (k % 2 == 0) == heavy_first ? light * ratio : light});
      Trial trial = resting(discs, 0.4);
      trial.scene.solver.name = solver;
      particles::Simulation simulation = trial.start();
      checks.push_back(at_most("error of a force / weight, 1:" + std::to_string(static_cast<int>(ratio)) +
                                   (heavy_first ? ", heavy below" : ", light below"),
                               1e-9 * ratio, load_error(simulation),
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
    Trial trial;
    trial.discs = {{0, 0.5 / std::sin(alpha)}};
    trial.scene.walls = {trial_segment("left", 0, 0, -far * std::sin(alpha), far * std::cos(alpha)),
                         trial_segment("right", 0, 0, far * std::sin(alpha), far * std::cos(alpha))};
    trial.scene.effects = {particles::Gravity{}, particles::Friction{mu, mu}, std::nullopt,
                           particles::Spin{}};
    trial.add_stage(50 * h, h);
    particles::Simulation simulation = trial.start();
    run_watched(simulation);
    double normal = 0;
    for (const particles::SnapshotContact& c : simulation.take_snapshot().contacts) normal += c.impulse_n / h;
    const particles::Bodies& b = simulation.state().bodies;
    const std::string suffix = ", half angle " + std::to_string(static_cast<int>(half_deg)) + " deg";
    checks.push_back(
        equals("speed" + suffix, 0, std::hypot(b.v_x[0], b.v_z[0], 0.5 * b.spin[0]), 1e-8, "residual 1e-9"));
    checks.push_back(at_most("sum of normal forces / weight" + suffix, 10,
                             normal / particles::mass_of_disc(0.5),
                             "any value that wedges is a solution; it must stay bounded"));
  }
  return checks;
}

std::vector<HardCheck> crystal() {
  const int across = 16, rows = 12;
  std::vector<TrialDisc> discs;
  for (int row = 0; row < rows; ++row)
    for (int k = 0; k < across - row % 2; ++k)
      discs.push_back({0.5 + k + 0.5 * (row % 2), 0.5 + row * std::sqrt(0.75)});
  Trial trial = resting(discs, 0.4);
  trial.scene.walls = {trial_floor(), trial_segment("left", 0, 0, 0, 100),
                       trial_segment("right", across, 0, across, 100)};
  trial.scene.solver.tolerance = 1e-7;
  particles::Simulation simulation = trial.start();
  const Watch watch = run_watched(simulation);
  const particles::Bodies& bodies = simulation.state().bodies;
  double push_x = 0, push_z = 0;
  for (const particles::SnapshotContact& c : simulation.take_snapshot().contacts) {
    if (c.j >= 0) continue;
    push_x += (c.normal_x * c.impulse_n + c.normal_z * c.impulse_t) / h;
    push_z += (c.normal_z * c.impulse_n - c.normal_x * c.impulse_t) / h;
  }
  const double weight = total_mass(bodies);
  return {equals("lift of the walls / weight", 1, push_z / weight, 1e-3, "residual of a hyperstatic packing"),
          equals("sideways push of the walls / weight", 0, push_x / weight, 1e-3, "as above"),
          at_most("rms speed / (g h)", 1e-3, std::sqrt(2 * particles::kinetic_energy(bodies) / weight) / h,
                  "at rest; forces are not unique and not compared"),
          at_most("overlap", 1e-5, watch.largest_overlap, "discs that touch do not sink")};
}

}  // namespace

std::vector<HardCase> static_cases() {
  return {
      {"column-100", "contact k of a column carries the weight above; solver nncg", true,
       [] { return column(100, "nncg"); }},
      {"column-1000", "the same with 1000 discs", false, [] { return column(1000, "nncg"); }},
      {"column-1000-default", "the same with the default solver", false,
       [] { return column(1000, particles::SolverSettings{}.name); }},
      {"mass-ratio",
       "columns of heavy and light discs in turn, 1:1e3 and 1:1e6, solver nncg: the weight above", true,
       [] { return mass_ratios("nncg"); }},
      {"mass-ratio-default", "the same with the default solver", true,
       [] { return mass_ratios(particles::SolverSettings{}.name); }},
      {"wedge", "a disc in a wedge of half angle alpha, mu >= tan alpha: at rest, forces bounded", true,
       wedge},
      {"crystal", "a monodisperse crystal at rest (hyperstatic): the walls carry its weight", true, crystal},
  };
}

}  // namespace drumlin
