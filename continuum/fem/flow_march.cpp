#include <fmt/format.h>

#include <cmath>

#include "continuum/fem/detail/kept_state.hpp"
#include "continuum/fem/detail/time_step.hpp"
#include "continuum/fem/flow_solver.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace {

using fem::Newton;
using fem::State;

// One step, cut in halves where Newton's method fails.
bool advance(Newton& newton, const FlowSolverOptions& options, double time_step, int depth,
             fem::SolvedLevel& level) {
  const State before = level.state;
  const auto kept = std::make_shared<fem::FieldVector>(before.solution);
  kept->update_ghost_values();
  const bool done = advance_once(
      newton, options, {.share = 1, .time_step = time_step, .before = kept, .mesh_velocity = nullptr}, level);
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
