#include "particles/stretches/stretch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/machine/own_costs.hpp"

namespace drumlin::particles {

Scene with_settings(const Scene& scene, const StretchSettings& settings, double parts) {
  Scene changed = scene;
  Stage& stage = changed.stages.back();
  stage.turns.reset();
  stage.until.reset();
  stage.duration_s = settings.length_s;
  stage.time_step_s =
      settings.length_s / (parts * std::ceil(settings.length_s / (parts * settings.step_s) - 1e-9));
  SolverSettings& solver = changed.solver;
  const double harder = std::clamp(solver.tolerance / settings.tolerance, 1.0, 1e4);
  solver.max_sweeps = static_cast<int>(std::min(1e6, std::ceil(solver.max_sweeps * harder)));
  solver.name = settings.solver;
  solver.tolerance = settings.tolerance;
  solver.stop_when_unconverged = false;
  solver.capture_unconverged = 0;
  return changed;
}

SimulationState at_last_stage(const Scene& scene, int threads,
                              const std::function<void(double share_done)>& after_step) {
  Simulation simulation(scene, threads);
  // Stages that end early bring the last one closer.
  const auto before_last = [&plan = simulation.plan()] { return plan.steps - plan.stages.back().steps; };
  while (simulation.state().step < before_last()) {
    const StepReport report = simulation.step();
    if (report.lost) throw NotConvergedError("a grain is lost on the way to the last stage");
    after_step(static_cast<double>(simulation.state().step) / static_cast<double>(before_last()));
  }
  return simulation.state();
}

std::vector<Mark> marks_along(const SweepStart& start, const StretchSettings& settings, int threads,
                              const std::function<void()>& after_step) {
  Simulation simulation(with_settings(start.scene, settings), start.state, threads);
  const std::int64_t steps = simulation.plan().stages.back().steps;
  std::vector<Mark> marks;
  Mark now;
  double overlap = 0;
  const double begun = own_cpu_seconds();
  for (std::int64_t step = 1; step <= steps; ++step) {
    const StepReport report = simulation.step();
    if (report.lost)
      throw NotConvergedError(fmt::format("{} to {:g} in steps of {:g} s: a grain is lost", settings.solver,
                                          settings.tolerance, settings.step_s));
    after_step();
    now.steps = step;
    now.sweeps += report.solve.sweeps;
    now.contact_sweeps += static_cast<double>(report.contacts) * report.solve.sweeps;
    now.missed += report.contacts > 0 && report.solve.status != Status::converged;
    overlap += report.overlap.mean;
    const std::int64_t quarters = 4 * step;
    if (quarters != steps && quarters != 2 * steps && quarters != 4 * steps) continue;
    now.cpu_seconds = own_cpu_seconds() - begun;
    now.overlap_d = overlap / static_cast<double>(step);
    now.bodies = simulation.state().bodies;
    marks.push_back(now);
  }
  return marks;
}

double least_seconds(const SweepStart& start, const StretchSettings& settings, int threads, double first,
                     const std::function<void()>& after_step) {
  double least = first, all = first;
  for (int again = 1; again < 5 && all < 0.5; ++again) {
    const double seconds = marks_along(start, settings, threads, after_step).back().cpu_seconds;
    least = std::min(least, seconds);
    all += seconds;
  }
  return least;
}

}  // namespace drumlin::particles
