// Impacts must not make energy.
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>

#include "particles/scene/random.hpp"
#include "tests/hardcases/particles/case_lists.hpp"
#include "tests/hardcases/particles/trial.hpp"

namespace drumlin {
namespace {

constexpr double rounding = 1e-9;  // of the energy; residual 1e-12

Trial strict() {
  Trial trial;
  trial.scene.solver.tolerance = 1e-12;
  trial.scene.solver.check_every = 1;
  return trial;
}

/// Two discs that meet at random, free, with any restitution and friction.
std::vector<HardCheck> single_contact() {
  particles::RandomStream random(1, "hard/single-contact");
  double worst = -1;
  for (int k = 0; k < 200; ++k) {
    Trial trial = strict();
    const double mu = k % 4 == 0 ? 10 : random.uniform(0, 1), e = k % 5 == 0 ? 1 : random.uniform(0, 1);
    const double angle = random.uniform(0, 6.28), diameter = random.uniform(0.2, 2);
    const double distance = (1 + diameter) / 2 + random.uniform(0, 0.1);
    trial.discs = {{0, 0, 1, 0, 0, random.uniform(-5, 5)},
                   {distance * std::cos(angle), distance * std::sin(angle), diameter,
                    -3 * std::cos(angle) + random.uniform(-2, 2),
                    -3 * std::sin(angle) + random.uniform(-2, 2), random.uniform(-5, 5)}};
    trial.scene.effects.friction = particles::Friction{mu, mu};
    trial.scene.effects.restitution = particles::Restitution{e, e};
    trial.scene.effects.spin = particles::Spin{};
    trial.add_stage(1, 0.0545);
    particles::Simulation simulation = trial.start();
    const double before = kinetic_energy(simulation.state().bodies);
    run_watched(simulation);
    worst = larger(worst, kinetic_energy(simulation.state().bodies) / before - 1);
  }
  return {at_most("largest relative gain, 200 pairs", rounding, worst, "residual 1e-12")};
}

/// Gain of energy of three discs in a row over gaps of the third, relative to the start.
double row_gain(double e) {
  double worst = -1;
  for (int k = 0; k <= 40; ++k) {
    Trial trial = strict();
    trial.discs = {{-1.02, 0, 1, 6}, {0, 0}, {1 + 0.02 * k, 0}};
    trial.scene.effects.restitution = particles::Restitution{e, e};
    trial.add_stage(0.6, 0.0545);
    particles::Simulation simulation = trial.start();
    const double before = kinetic_energy(simulation.state().bodies);
    run_watched(simulation);
    worst = larger(worst, kinetic_energy(simulation.state().bodies) / before - 1);
  }
  return worst;
}

std::vector<HardCheck> three_in_a_row(std::initializer_list<double> restitutions) {
  std::vector<HardCheck> checks;
  for (const double e : restitutions)
    checks.push_back(at_most("largest relative gain, e = " + std::to_string(e).substr(0, 4), rounding,
                             row_gain(e), "residual 1e-12"));
  return checks;
}

/// Free discs of two sizes in a box, thrown at random.
Trial gas(double e, double h, double duration) {
  Trial trial = strict();
  particles::RandomStream random(2, "hard/gas");
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 8; ++k)
      trial.discs.push_back({1.2 * i - 4.2 + random.uniform(-0.05, 0.05),
                             1.2 * k - 4.2 + random.uniform(-0.05, 0.05), (i + k) % 2 ? 1.1 : 0.9,
                             random.uniform(-2, 2), random.uniform(-2, 2)});
  trial.scene.walls = trial_box(5);
  trial.scene.effects.restitution = particles::Restitution{e, e};
  trial.add_stage(duration, h);
  return trial;
}

std::vector<HardCheck> gas_energy() {
  std::vector<HardCheck> checks;
  for (const double e : {0.46, 0.9, 1.0}) {
    particles::Simulation simulation = gas(e, 0.0545, 20).start();
    const double before = kinetic_energy(simulation.state().bodies);
    const Watch watch = run_watched(simulation);
    const std::string suffix = ", e = " + std::to_string(e).substr(0, 4);
    checks.push_back(at_most("largest relative rise in a step" + suffix, rounding,
                             watch.largest_rise / before, "residual 1e-12"));
    checks.push_back(at_most("overlap" + suffix, 1e-2, watch.largest_overlap, "dense, at 2 sqrt(g d)"));
    if (e == 1)
      checks.push_back(equals("energy at the end / at the start" + suffix, 1,
                              kinetic_energy(simulation.state().bodies) / before, 1e-6,
                              "elastic: all of it is kept but what 2000 impacts round off"));
  }
  return checks;
}

}  // namespace

std::vector<HardCase> energy_cases() {
  return {
      {"three-in-a-row", "three discs in a row, uniform e up to 0.7, no friction: energy never rises", true,
       [] {
         return three_in_a_row({0.0, 0.46, 0.7});
       }},
      {"three-in-a-row-elastic", "the same with e above 0.7", false,
       [] {
         return three_in_a_row({0.9, 1.0});
       }},
      {"single-contact-energy", "two discs, any e and mu: energy never rises (Newton's law, W_nt = 0)", false,
       single_contact},
      {"gas-energy", "64 discs in a box, uniform e, no friction: energy never rises, and is kept for e = 1",
       false, gas_energy},
  };
}

}  // namespace drumlin
