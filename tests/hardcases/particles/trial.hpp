#pragma once
// Small scenes built in code, in the units of the engine: discs one by one, walls, one stage.
#include <vector>

#include "particles/scene/scene.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin {

/// A disc of a trial; d, sqrt(d/g).
struct TrialDisc {
  double x = 0, z = 0, diameter = 1, v_x = 0, v_z = 0, spin = 0;
  double mass = 0;  ///< 0: that of its diameter
};

/// A scene whose unit d is 1 mm and g = 9.81 m/s2. Its solver is strict: to a residual of 1e-9.
struct Trial {
  Trial();
  particles::Scene scene;
  std::vector<TrialDisc> discs;

  void add_stage(double duration, double time_step);
  /// Turns a wall at `spin` (1/sqrt(d/g)) about the origin in the last stage.
  void turn(const std::string& wall, double spin);
  particles::Simulation start(int threads = 1) const;
};

particles::Wall trial_segment(const std::string& name, double x0, double z0, double x1, double z1);
particles::Wall trial_floor();
particles::Wall trial_container(double radius);
/// Four walls with their corners at (+-half, +-half).
std::vector<particles::Wall> trial_box(double half);

/// What a run did, step by step.
struct Watch {
  int steps = 0;
  int steps_not_finite = 0;    ///< with a NaN or infinity in a position or velocity
  int steps_lost = 0;          ///< that report a lost grain
  int steps_missed = 0;        ///< whose solve missed a tolerance
  double largest_kinetic = 0;  ///< energy, of all discs
  double largest_rise = 0;     ///< of the kinetic energy within a step
  double largest_overlap = 0;  ///< of a loaded contact before the projection, d
  double largest_mean_overlap = 0;
};
/// Runs to the end. `each_step` sees the state after each step.
template <class EachStep>
Watch run_watched(particles::Simulation& simulation, EachStep&& each_step);
Watch run_watched(particles::Simulation& simulation);

namespace detail {
void watch_step(Watch&, const particles::Bodies&, const particles::StepReport&, double kinetic_before);
}

template <class EachStep>
Watch run_watched(particles::Simulation& simulation, EachStep&& each_step) {
  Watch watch;
  while (!simulation.finished()) {
    const double before = kinetic_energy(simulation.state().bodies);
    const particles::StepReport report = simulation.step();
    detail::watch_step(watch, simulation.state().bodies, report, before);
    each_step(simulation);
  }
  return watch;
}

/// Bodies at the end of a trial.
particles::Bodies end_of(const Trial&, int threads = 1);
double total_mass(const particles::Bodies&);

}  // namespace drumlin
