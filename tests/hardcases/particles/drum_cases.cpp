// Whole drums under conditions that a simulation is not made for: nothing may be lost, nothing may blow up.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/trends.hpp"
#include "tests/hardcases/particles/trial.hpp"

namespace drumlin {
using namespace particles;
namespace {

struct DrumSize {
  int grains = 120;
  double radius_mm = 30, smallest_mm = 3, largest_mm = 3.6;
};

Scene drum(const DrumSize& size, double mu) {
  Scene scene;
  scene.title = "hard case";
  scene.grains.density_kg_m3 = 2700;
  scene.grains.source =
      GeneratedGrains{size.grains, size.smallest_mm, size.largest_mm, CircleRegion{{0, 0}, size.radius_mm}};
  scene.walls = {{"drum", ContainerShape{{0, 0}, size.radius_mm}}};
  scene.effects = {Gravity{}, Friction{mu, mu}, Restitution{0.46, 0.46}, Spin{}};
  scene.output.velocity_window_s = 0;
  return scene;
}

void add_stage(Scene& scene, double seconds, double step, double rpm) {
  Stage stage;
  stage.name = "stage" + std::to_string(scene.stages.size() + 1);
  stage.duration_s = seconds;
  stage.time_step_s = step;
  if (rpm != 0) stage.motions = {{"drum", Rotation{rpm, {0, 0}}}};
  scene.stages.push_back(stage);
}

/// Discs whose centre is not within the drum of that radius.
int lost(const Bodies& b, double radius) {
  int count = 0;
  for (std::size_t k = 0; k < b.count(); ++k) count += !(std::hypot(b.x[k], b.z[k]) < radius);
  return count;
}

/// Kinetic energy that falling through the whole drum and moving with its wall would give.
double energy_at_most(const Bodies& b, double radius, double wall_speed) {
  return total_mass(b) * (2 * radius + wall_speed * wall_speed);
}

struct DrumRun {
  Watch watch;
  Bodies end;
  double radius = 0;  ///< d
};

DrumRun run_drum(const Scene& scene) {
  Simulation simulation(scene);
  DrumRun result;
  result.watch = run_watched(simulation);
  result.end = simulation.state().bodies;
  result.radius =
      std::get<ContainerShape>(scene.walls[0].shape).radius_mm * 1e-3 / simulation.scales().length_m;
  return result;
}

std::vector<HardCheck> sound(const DrumRun& run, double wall_speed, double mean_overlap,
                             const std::string& overlap_reason) {
  return {at_most("steps with NaN", 0, run.watch.steps_not_finite, "none"),
          at_most("discs lost", 0, lost(run.end, run.radius), "none"),
          at_most("kinetic energy / (m g 2 R + m v_wall^2)", 1,
                  run.watch.largest_kinetic / energy_at_most(run.end, run.radius, wall_speed),
                  "what a fall through the drum and the wall's speed can give"),
          at_most("mean overlap of loaded contacts, at worst", mean_overlap, run.watch.largest_mean_overlap,
                  overlap_reason)};
}

double wall_speed_of(const DrumRun& run, const Scene& scene, double rpm) {
  return run.radius * rpm * 2 * std::numbers::pi / 60 * scales_of(scene).time_s;
}

std::vector<HardCheck> step_ten_times_too_large() {
  Scene scene = drum({}, 0.4);
  add_stage(scene, 1, 1e-2, 0);
  add_stage(scene, 2, 1e-2, 6);
  const DrumRun run = run_drum(scene);
  return sound(run, wall_speed_of(run, scene, 6), 0.1,
               "discs fall 3 d per step; the mean of the paper's step of 6e-3 s is 0.016 d");
}

std::vector<HardCheck> friction_ten() {
  Scene scene = drum({}, 10);
  add_stage(scene, 0.4, 1e-3, 0);
  add_stage(scene, 2, 1e-3, 6);
  const DrumRun run = run_drum(scene);
  return sound(run, wall_speed_of(run, scene, 6), 5e-3, "ten times the drum with friction 0.4");
}

/// Kinetic and potential energy, zero on the level of the drum's axis.
double mechanical_energy(const Bodies& b) {
  double energy = kinetic_energy(b);
  for (std::size_t k = 0; k < b.count(); ++k) energy += b.z[k] / b.inverse_mass[k];
  return energy;
}

std::vector<HardCheck> friction_zero() {
  Scene scene = drum({}, 0);
  add_stage(scene, 1.5, 1e-3, 0);
  add_stage(scene, 2, 1e-3, 6);
  Simulation simulation(scene);
  DrumRun run;
  run.radius = 30e-3 / simulation.scales().length_m;
  double settled = 0;
  run.watch = run_watched(simulation, [&](const Simulation& s) {
    if (s.state().stage == 0) settled = mechanical_energy(s.state().bodies);
  });
  run.end = simulation.state().bodies;
  auto checks = sound(run, wall_speed_of(run, scene, 6), 5e-3, "ten times the drum with friction 0.4");
  double spin = 0;
  for (const double s : run.end.spin) spin = larger(spin, std::abs(s));
  checks.push_back(equals("largest spin", 0, spin, 1e-15, "nothing turns a disc without friction"));
  checks.push_back(at_most("energy gained while it turns / (m g d)", 1e-2,
                           (mechanical_energy(run.end) - settled) / total_mass(run.end),
                           "a smooth circle does no work; the energy of a swinging heap is known to g h v"));
  return checks;
}

std::vector<HardCheck> size_ratio() {
  Scene scene = drum({300, 100, 0.2, 10}, 0.4);
  add_stage(scene, 1, 5e-4, 0);
  add_stage(scene, 1, 5e-4, 6);
  const DrumRun run = run_drum(scene);
  return sound(run, wall_speed_of(run, scene, 6), 5e-3, "mean disc; ten times the drum of equal discs");
}

std::vector<HardCheck> centrifuge() {
  const double rpm = 200;  // R Omega^2 = 9 g: a bed that rests up to a slope of 6.4 deg stays
  Scene scene = drum({300, 200, 11, 13}, 0.9);
  add_stage(scene, 4, 1e-3, rpm);
  const DrumRun run = run_drum(scene);
  const double omega = rpm * 2 * std::numbers::pi / 60 * scales_of(scene).time_s;
  double slowest = HUGE_VAL, fastest = 0, mean = 0;
  for (std::size_t k = 0; k < run.end.count(); ++k) {
    const double x = run.end.x[k], z = run.end.z[k];
    const double turning = (z * run.end.v_x[k] - x * run.end.v_z[k]) / (x * x + z * z) / omega;
    slowest = std::min(slowest, turning), fastest = larger(fastest, turning);
    mean += turning / static_cast<double>(run.end.count());
  }
  auto checks = sound(run, wall_speed_of(run, scene, rpm), 5e-3, "ten times the drum of 6 rpm");
  const double swing = 2.0 / 3 / (run.radius * omega * omega);
  const std::string why = "a disc free to roll would swing by 2/3 g/(R Omega^2); those in the bed do less";
  checks.push_back(equals("mean turning / wall", 1, mean, 0.01, "the bed turns as one; residual 1e-2"));
  checks.push_back(equals("slowest turning / wall", 1, slowest, swing, why));
  checks.push_back(equals("fastest turning / wall", 1, fastest, swing, why));
  return checks;
}

std::vector<HardCheck> hundred_turns() {
  const double rpm = 2, step = 3e-3, turn_s = 60 / rpm;
  const int turns = 100, dropped = 10;
  Scene scene = drum({40, 130, 28, 32}, 0.4);
  add_stage(scene, 1, step, 0);
  add_stage(scene, turns * turn_s, step, rpm);
  Simulation simulation(scene);
  // Means over each turn.
  std::vector<double> x, z, energy, overlap;
  double sum_x = 0, sum_z = 0, sum_energy = 0, sum_overlap = 0;
  std::int64_t in_turn = 0;
  Watch watch;
  const auto steps_per_turn = simulation.plan().stages[1].steps / turns;
  while (!simulation.finished()) {
    const double before = kinetic_energy(simulation.state().bodies);
    const StepReport report = simulation.step();
    const Bodies& b = simulation.state().bodies;
    detail::watch_step(watch, b, report, before);
    if (simulation.state().stage == 0) continue;
    for (std::size_t k = 0; k < b.count(); ++k)
      sum_x += b.x[k] / b.inverse_mass[k], sum_z += b.z[k] / b.inverse_mass[k];
    sum_energy += kinetic_energy(b);
    sum_overlap += report.overlap.mean;
    if (++in_turn < steps_per_turn) continue;
    const double steps = static_cast<double>(in_turn), mass = total_mass(b);
    x.push_back(sum_x / steps / mass), z.push_back(sum_z / steps / mass);
    energy.push_back(sum_energy / steps / mass), overlap.push_back(sum_overlap / steps);
    sum_x = sum_z = sum_energy = sum_overlap = 0, in_turn = 0;
  }
  const double radius = 130e-3 / simulation.scales().length_m;
  std::vector<HardCheck> checks{
      at_most("steps with NaN", 0, watch.steps_not_finite, "none"),
      at_most("discs lost", 0, lost(simulation.state().bodies, radius), "none"),
      at_most("mean overlap of loaded contacts, worst turn", 2e-3,
              *std::max_element(overlap.begin(), overlap.end()), "ten times the drum of 6 rpm")};
  for (auto [what, values] : {std::pair("centre of mass x", &x), std::pair("centre of mass z", &z),
                              std::pair("kinetic energy", &energy), std::pair("mean overlap", &overlap)}) {
    values->erase(values->begin(), values->begin() + dropped);
    const Trend trend = trend_of(*values);
    checks.push_back(equals(std::string("drift of the ") + what + " / its standard error", 0,
                            trend.slope / trend.error, 4,
                            "chance alone exceeds 4 once in 2000 (Student, 16 degrees of freedom)"));
  }
  return checks;
}

}  // namespace

std::vector<HardCase> drum_cases() {
  return {
      {"step-times-10", "a drum at h = 1e-2 s, ten times too large: bounded, nothing lost", true,
       step_ten_times_too_large},
      {"friction-0", "a turning drum without friction: the wall does no work, nothing spins", true,
       friction_zero},
      {"friction-10", "a turning drum with friction 10: bounded, nothing lost", true, friction_ten},
      {"size-ratio", "diameters from 1 to 50: bounded, nothing lost", true, size_ratio},
      {"centrifuge", "200 rpm, 9 g at the wall: the bed turns with it", false, centrifuge},
      {"hundred-turns", "100 turns at 2 rpm: no drift of mass centre, energy and overlap", false,
       hundred_turns},
  };
}

}  // namespace drumlin
