// Whole drums under conditions that a simulation is not made for: nothing may be lost, nothing may blow up.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/trends.hpp"
#include "tests/hardcases/particles/watch.hpp"

namespace drumlin {
using namespace test;
namespace {

struct DrumSize {
  int grains = 120;
  double radius_mm = 30, smallest_mm = 3, largest_mm = 3.6;
};

TestScene drum(const DrumSize& size, double mu) {
  return scene_of(GeneratedGrains{size.grains, size.smallest_mm, size.largest_mm,
                                  CircleRegion{{0, 0}, size.radius_mm}})
      .between({drum_wall(size.radius_mm)})
      .with(Gravity{}, Friction{mu, mu}, Restitution{0.46, 0.46}, Spin{});
}

void add_stage(TestScene& scene, double seconds, double step, double rpm) {
  scene.lasting(seconds / time_s, step / time_s);
  if (rpm != 0) scene.moving("drum", Rotation{rpm, {0, 0}});
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

/// A drum that settles and then turns.
struct DrumRun {
  TestScene scene;
  double rpm = 6;
  TestRun run{scene};
  double radius = std::get<ContainerShape>(scene.walls[0].shape).radius_mm * 1e-3 / run.scales().length_m;
  double omega = rpm * 2 * std::numbers::pi / 60 * run.scales().time_s;

  std::vector<HardCheck> sound(const Watch& watch, double mean_overlap, const std::string& reason) const {
    const double speed = radius * omega;
    return {at_most("steps with NaN", 0, watch.steps_not_finite, "none"),
            at_most("discs lost", 0, lost(run.bodies(), radius), "none"),
            at_most("kinetic energy / (m g 2 R + m v_wall^2)", 1,
                    watch.largest_kinetic / energy_at_most(run.bodies(), radius, speed),
                    "what a fall through the drum and the wall's speed can give"),
            at_most("mean overlap of loaded contacts, at worst", mean_overlap, watch.largest_mean_overlap,
                    reason)};
  }
};

TestScene settling_drum(const DrumSize& size, double mu, double step, double settles_s, double turns_s) {
  TestScene scene = drum(size, mu);
  add_stage(scene, settles_s, step, 0);
  add_stage(scene, turns_s, step, 6);
  return scene;
}

std::vector<HardCheck> sound(const TestScene& scene, double mean_overlap, const std::string& reason) {
  DrumRun drum{scene};
  return drum.sound(run_watched(drum.run), mean_overlap, reason);
}

std::vector<HardCheck> step_ten_times_too_large() {
  return sound(settling_drum({}, 0.4, 1e-2, 1, 2), 0.1,
               "discs fall 3 d per step; the mean of the paper's step of 6e-3 s is 0.016 d");
}

std::vector<HardCheck> friction_ten() {
  return sound(settling_drum({}, 10, 1e-3, 0.4, 2), 5e-3, "ten times the drum with friction 0.4");
}

std::vector<HardCheck> size_ratio() {
  return sound(settling_drum({300, 100, 0.2, 10}, 0.4, 5e-4, 1, 1), 5e-3,
               "mean disc; ten times the drum of equal discs");
}

/// Kinetic and potential energy, zero on the level of the drum's axis.
double mechanical_energy(const Bodies& b) {
  double energy = kinetic_energy(b);
  for (std::size_t k = 0; k < b.count(); ++k) energy += b.z[k] / b.inverse_mass[k];
  return energy;
}

std::vector<HardCheck> friction_zero() {
  DrumRun drum{settling_drum({}, 0, 1e-3, 1.5, 2)};
  const Bodies& end = drum.run.bodies();
  double settled = 0;
  const Watch watch = run_watched(drum.run, [&] {
    if (drum.run.state().stage == 0) settled = mechanical_energy(end);
  });
  auto checks = drum.sound(watch, 5e-3, "ten times the drum with friction 0.4");
  double spin = 0;
  for (const double s : end.spin) spin = larger(spin, std::abs(s));
  checks.push_back(equals("largest spin", 0, spin, 1e-15, "nothing turns a disc without friction"));
  checks.push_back(at_most("energy gained while it turns / (m g d)", 1e-2,
                           (mechanical_energy(end) - settled) / total_mass(end),
                           "a smooth circle does no work; the energy of a swinging heap is known to g h v"));
  return checks;
}

std::vector<HardCheck> centrifuge() {
  const double rpm = 200;  // R Omega^2 = 9 g: a bed that rests up to a slope of 6.4 deg stays
  TestScene scene = drum({300, 200, 11, 13}, 0.9);
  add_stage(scene, 4, 1e-3, rpm);
  DrumRun drum{scene, rpm};
  const Watch watch = run_watched(drum.run);
  const Bodies& end = drum.run.bodies();
  double slowest = HUGE_VAL, fastest = 0, mean = 0;
  for (std::size_t k = 0; k < end.count(); ++k) {
    const double x = end.x[k], z = end.z[k];
    const double turning = (z * end.v_x[k] - x * end.v_z[k]) / (x * x + z * z) / drum.omega;
    slowest = std::min(slowest, turning), fastest = larger(fastest, turning);
    mean += turning / static_cast<double>(end.count());
  }
  auto checks = drum.sound(watch, 5e-3, "ten times the drum of 6 rpm");
  const double swing = 2.0 / 3 / (drum.radius * drum.omega * drum.omega);
  const std::string why = "a disc free to roll would swing by 2/3 g/(R Omega^2); those in the bed do less";
  checks.push_back(equals("mean turning / wall", 1, mean, 0.01, "the bed turns as one; residual 1e-2"));
  checks.push_back(equals("slowest turning / wall", 1, slowest, swing, why));
  checks.push_back(equals("fastest turning / wall", 1, fastest, swing, why));
  return checks;
}

std::vector<HardCheck> hundred_turns() {
  const double rpm = 2, step = 3e-3, turn_s = 60 / rpm;
  const int turns = 100, dropped = 10;
  TestScene scene = drum({40, 130, 28, 32}, 0.4);
  add_stage(scene, 1, step, 0);
  add_stage(scene, turns * turn_s, step, rpm);
  DrumRun drum{scene, rpm};
  const Bodies& b = drum.run.bodies();
  constexpr std::array names{"centre of mass x", "centre of mass z", "kinetic energy", "mean overlap"};
  std::array<std::vector<double>, 4> means;  // over each turn
  std::array<double, 4> sums{};
  std::int64_t in_turn = 0;
  const auto steps_per_turn = drum.run.plan().stages[1].steps / turns;
  const Watch watch = run_watched(drum.run, [&](const StepReport& report) {
    if (drum.run.state().stage == 0) return;
    const double mass = total_mass(b);
    for (std::size_t k = 0; k < b.count(); ++k)
      sums[0] += b.x[k] / b.inverse_mass[k] / mass, sums[1] += b.z[k] / b.inverse_mass[k] / mass;
    sums[2] += kinetic_energy(b) / mass, sums[3] += report.overlap.mean;
    if (++in_turn < steps_per_turn) return;
    for (std::size_t q = 0; q < 4; ++q)
      means[q].push_back(std::exchange(sums[q], 0) / static_cast<double>(in_turn));
    in_turn = 0;
  });
  std::vector<HardCheck> checks{
      at_most("steps with NaN", 0, watch.steps_not_finite, "none"),
      at_most("discs lost", 0, lost(b, drum.radius), "none"),
      at_most("mean overlap of loaded contacts, worst turn", 2e-3,
              *std::max_element(means[3].begin(), means[3].end()), "ten times the drum of 6 rpm")};
  for (std::size_t q = 0; q < 4; ++q) {
    const Trend trend = trend_of({means[q].begin() + dropped, means[q].end()});
    checks.push_back(equals(std::string("drift of the ") + names[q] + " / its standard error", 0,
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
