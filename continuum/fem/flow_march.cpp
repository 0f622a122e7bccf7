#include <fmt/format.h>

#include <cmath>

#include "continuum/fem/detail/kept_state.hpp"
#include "continuum/fem/detail/newton.hpp"
#include "continuum/fem/flow_solver.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace {

using fem::Newton;
using fem::Phase;
using fem::State;

// Where nothing moves yet, Newton's method knows no direction of D: a fluid first, then the law at smaller
// and smaller eps.
bool advance_carefully(Newton& newton, const FlowSolverOptions& options, Phase phase,
                       fem::SolvedLevel& level) {
  const double last = phase.setting.regularisation.shear_rate, tolerance = phase.tolerance;
  const StressLaw law = phase.setting.law;
  phase.name = "start";
  phase.tolerance = options.phase_tolerance;
  phase.setting.law = NewtonianLaw{1};
  phase.setting.regularisation.shear_rate = std::max(last, options.start_shear_rate);
  if (!run(newton, phase, level)) return false;
  phase.setting.law = law;
  for (double eps = phase.setting.regularisation.shear_rate; run(newton, phase, level);) {
    if (eps == last) return true;
    eps *= 0.1;
    if (eps < 1.5 * last) eps = last;
    phase.setting.regularisation.shear_rate = eps;
    if (eps == last) phase.tolerance = tolerance;
  }
  return false;
}

// One step, cut in halves where Newton's method fails.
bool advance(Newton& newton, const FlowSolverOptions& options, double time_step, int depth,
             fem::SolvedLevel& level) {
  const State before = level.state;
  const auto& d = *level.discretisation;
  const bool at_rest = before.solution.l2_norm() == 0;
  const auto kept = std::make_shared<fem::FieldVector>(before.solution);
  kept->update_ghost_values();
  Phase phase{"time step", fem::final_setting(level.problem), options.tolerance};
  phase.setting.inertia = fem::InertiaSetting{.share = 1, .time_step = time_step, .before = kept};
  d.constraints.distribute(level.state.solution);  // what the sides do now
  level.state.solution.update_ghost_values();
  // Of the start of the step: an error of first order in it, as the method's own. At rest there are no axes
  // to turn against.
  level.state.held = nullptr;
  if (fem::holds_fields(level.problem) && !at_rest)
    level.state.held =
        fem::held_from(level.problem, d, before, {.linear_tolerance = options.linear_tolerance});
  const bool done = at_rest ? advance_carefully(newton, options, phase, level) : run(newton, phase, level);
  if (done) return true;
  if (depth == 0 || newton.was_interrupted()) return false;
  level.state = before;
  return advance(newton, options, 0.5 * time_step, depth - 1, level) &&
         advance(newton, options, 0.5 * time_step, depth - 1, level);
}

std::shared_ptr<fem::SolvedLevel> coarsest_level(const FlowProblem& problem) {
  auto level = std::make_shared<fem::SolvedLevel>();
  level->problem = problem;
  level->problem.frame = std::nullopt;
  level->discretisation = std::make_shared<fem::Discretisation>(level->problem);
  level->state.solution = level->discretisation->field();
  return level;
}

}  // namespace

FlowSolution march_flow(const FlowField& start, const FlowProblem& problem, const FlowMarch& march,
                        const FlowSolverOptions& options, const FlowObserver& observer) {
  if (problem.nonlocal || problem.threshold_fluidity || problem.memory)
    throw InputError(
        "steps in time know neither memory of the axes nor nonlocal fluidity: the state that they go on from "
        "holds velocity and pressure alone");
  const double begun = fem::now();
  FlowProblem unsteady = problem;
  unsteady.inertia = Inertia{};
  auto level = std::make_shared<fem::SolvedLevel>(start.level());
  level->problem = unsteady;
  level->problem.frame = std::nullopt;
  auto& d = *level->discretisation;
  d.constrain(level->problem);
  FlowReport report;
  report.start = "march";
  fem::WorkClock clock;
  Newton newton(level->problem, options, d, 0, begun, clock, report, observer);
  for (int step = march.first + 1; step <= march.first + march.steps; ++step) {
    const double time = step * march.time_step;
    if (march.boundary) {
      level->problem.boundary = march.boundary(time);
      d.constrain(level->problem);
    }
    if (!advance(newton, options, march.time_step, march.halvings, *level)) break;
    report.failure.clear();
    if (march.stepped) march.stepped(time, fem::field_of(level));
    report.converged = step == march.first + march.steps;
  }
  report.seconds = fem::now() - begun;
  for (std::size_t i = 0; i < fem::work_names.size(); ++i)
    report.phases.push_back({fem::work_names[i], clock.seconds(static_cast<fem::Work>(i)),
                             clock.times(static_cast<fem::Work>(i))});
  return {report, fem::field_of(level)};
}

FlowField flow_of_state(const FlowState& kept, const FlowProblem& problem, const FlowSolverOptions& options) {
  auto level = coarsest_level(problem);
  auto& d = *level->discretisation;
  fem::refine_to(kept, options, *level);
  if (!kept.surface.empty() && !d.move_surface(level->problem, {problem.domain, kept.surface}))
    throw InputError("the surface of the kept flow does not fit into this mesh");
  fem::lay_down(kept, *level);
  level->setting = fem::final_setting(level->problem);
  level->state.dual = fem::dual_of(d, level->setting.regularisation, level->state.solution);
  return FlowField(level);
}

FlowField flow_at_rest(const FlowProblem& problem, const FlowSolverOptions& options) {
  auto level = coarsest_level(problem);
  auto& d = *level->discretisation;
  for (int mesh = 0; mesh + 1 < options.levels; ++mesh) d.refine(level->problem, level->state.solution);
  auto& state = level->state;
  state.solution = d.field();
  state.solution.update_ghost_values();
  if (const auto* fixed = std::get_if<FixedSlope>(&problem.slope))
    state.theta = fixed->theta;
  else
    state.theta = std::get<SlopeFromMoment>(problem.slope).first_guess;
  level->setting = fem::final_setting(level->problem);
  state.dual = fem::dual_of(d, level->setting.regularisation, state.solution);
  return FlowField(level);
}

}  // namespace drumlin::continuum
