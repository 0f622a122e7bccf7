#include <fmt/format.h>

#include <cmath>

#include "continuum/fem/detail/newton.hpp"
#include "continuum/fem/detail/turning.hpp"
#include "continuum/fem/flow_solver.hpp"
#include "coupling/exchange/errors.hpp"

namespace drumlin {
namespace {

using fem::Newton;
using fem::Phase;
using fem::State;

// One step, cut in halves where Newton's method fails.
bool advance(Newton& newton, const FlowSolverOptions& options, double time_step, int depth,
             fem::SolvedLevel& level) {
  const State before = level.state;
  if (level.problem.turned)  // of the start of the step: an error of first order in it, as the method's own
    level.state.turning = fem::turning_of(level.problem, *level.discretisation,
                                          level.problem.regularisation.shear_rate, before.solution);
  Phase phase{"time step", fem::final_setting(level.problem, before.theta), options.tolerance};
  phase.setting.inertia = fem::InertiaSetting{.share = 1, .time_step = time_step, .before = &before.solution};
  const bool done = run(newton, phase, level);
  level.setting.inertia->before = nullptr;
  if (done) return true;
  if (depth == 0 || newton.was_interrupted()) return false;
  level.state = before;
  return advance(newton, options, 0.5 * time_step, depth - 1, level) &&
         advance(newton, options, 0.5 * time_step, depth - 1, level);
}

}  // namespace

FlowSolution march_flow(const FlowField& start, const FlowProblem& problem, const FlowMarch& march,
                        const FlowSolverOptions& options, const FlowObserver& observer) {
  const double begun = fem::now();
  FlowProblem unsteady = problem;
  unsteady.inertia = Inertia{};
  auto level = fem::level_for(start, unsteady);
  const auto& d = *level->discretisation;
  FlowReport report;
  report.start = "march";
  fem::WorkClock clock;
  Newton newton(level->problem, options, d, 0, begun, clock, report, observer);
  for (int step = 1; step <= march.steps; ++step) {
    if (!advance(newton, options, march.time_step, march.halvings, *level)) break;
    if (march.stepped) march.stepped(step * march.time_step, fem::field_of(level));
    report.converged = step == march.steps;
  }
  report.seconds = fem::now() - begun;
  return {report, fem::field_of(level)};
}

}  // namespace drumlin
