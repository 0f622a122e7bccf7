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

// A flow on its way.
class Marching {
 public:
  Marching(const FlowMarch& march, const FlowSolverOptions& options, Newton& newton, fem::SolvedLevel& level)
      : march_(march), options_(options), newton_(newton), level_(level) {}

  /// One step, cut in halves where Newton's method fails.
  bool advance(double time, double time_step, int depth) {
    const State before = level_.state;
    if (attempt(time, time_step, before.solution)) return true;
    if (depth == 0 || newton_.was_interrupted()) return false;
    level_.state = before;
    return advance(time, 0.5 * time_step, depth - 1) &&
           advance(time + 0.5 * time_step, 0.5 * time_step, depth - 1);
  }

 private:
  bool attempt(double time, double time_step, const fem::FieldVector& start) {
    const fem::Stage first = fem::to_middle(time_step, rate_ != nullptr), second = fem::to_end(time_step);
    if (!reach(time + 0.5 * time_step, first, from_of(first, start, start, rate_.get()))) return false;
    const fem::FieldVector from = from_of(second, start, level_.state.solution, nullptr);
    if (!reach(time + time_step, second, from)) return false;
    rate_ = rate_of(second, from, level_.state.solution);
    return true;
  }
  bool reach(double time, const fem::Stage& stage, const fem::FieldVector& from) {
    if (march_.boundary) {
      level_.problem.boundary = march_.boundary(time);
      level_.discretisation->constrain(level_.problem);
    }
    return advance_once(newton_, options_, stage, from, rate_.get(), {}, level_);
  }

  const FlowMarch& march_;
  const FlowSolverOptions& options_;
  Newton& newton_;
  fem::SolvedLevel& level_;
  std::shared_ptr<const fem::FieldVector> rate_;
};

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
  if (const auto* fixed = std::get_if<FixedSlope>(&problem.slope)) level->state.theta = fixed->theta;
  auto& d = *level->discretisation;
  d.constrain(level->problem);
  FlowReport report;
  report.start = "march";
  fem::WorkClock clock;
  Newton newton(level->problem, options, d, 0, begun, clock, report, observer);
  Marching marching(march, options, newton, *level);
  for (int step = march.first + 1; step <= march.first + march.steps; ++step) {
    const double time = step * march.time_step;
    if (!marching.advance(time - march.time_step, march.time_step, march.halvings)) break;
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
