#include "continuum/fem/flow_solver.hpp"

#include <cmath>

#include "continuum/fem/detail/kept_state.hpp"
#include "continuum/fem/detail/newton.hpp"
#include "continuum/fem/detail/settle.hpp"
#include "continuum/fem/detail/settle_surface.hpp"
#include "coupling/exchange/errors.hpp"

namespace drumlin {
namespace {

using fem::field_of;
using fem::final_setting;
using fem::lower_shear_rate;
using fem::Newton;
using fem::now;
using fem::Phase;
using fem::run;
using fem::Setting;
using fem::settle_held;
using fem::State;
using fem::Work;
using fem::WorkClock;

// Everything before eps goes down on the first mesh: from a Newtonian fluid to the law at a large eps, where
// it is nearly one.
std::vector<Phase> cold_phases(const FlowProblem& problem, const FlowSolverOptions& options) {
  Setting setting = final_setting(problem);
  if (std::holds_alternative<NewtonianLaw>(problem.law)) return {{"newtonian", setting, options.tolerance}};
  setting.regularisation.shear_rate = std::max(problem.regularisation.shear_rate, options.start_shear_rate);
  const Setting newtonian{NewtonianLaw{1}, setting.regularisation, std::nullopt};
  return {{"newtonian", newtonian, options.phase_tolerance}, {"law", setting, options.phase_tolerance}};
}

// From slow flow to full inertia; a step that fails is halved. All of inertia is a few per cent of the
// weight: within the tolerance of the other phases nothing would follow it.
bool raise_inertia(Newton& newton, const FlowSolverOptions& options, fem::SolvedLevel& level) {
  double share = 0, step = 1;
  while (share < 1) {
    const double next = std::min(1.0, share + step);
    Phase phase{"inertia", level.setting,
                next < 1 ? std::max(options.tolerance, options.coarse_tolerance) : options.tolerance};
    phase.setting.inertia = fem::InertiaSetting{.share = next};
    const State before = level.state;
    if (run(newton, phase, level)) {
      share = next;
      continue;
    }
    step *= 0.5;
    if (step < 0.01 || newton.was_interrupted()) return false;
    level.state = before;
  }
  return true;
}

bool solve_cold(Newton& newton, const FlowSolverOptions& options, fem::SolvedLevel& level) {
  auto list = cold_phases(level.problem, options);
  const double tolerance =
      level.problem.inertia ? std::max(options.tolerance, options.coarse_tolerance) : options.tolerance;
  if (list.back().setting.regularisation.shear_rate <= level.problem.regularisation.shear_rate)
    list.back().tolerance = tolerance;
  for (const Phase& phase : list)
    if (!run(newton, phase, level)) return false;
  return lower_shear_rate(newton, options, tolerance, level) &&
         (!level.problem.inertia || raise_inertia(newton, options, level));
}

// From a solution nearby: that of a coarser mesh ("refined") or of another problem ("neighbour").
bool solve_from(const std::string& name, Newton& newton, const FlowSolverOptions& options,
                fem::SolvedLevel& level) {
  const State before = level.state;
  Phase phase{name, final_setting(level.problem), options.tolerance};
  if (level.problem.inertia) phase.setting.inertia = fem::InertiaSetting{};
  if (run(newton, phase, level)) return true;
  if (newton.was_interrupted() || !(phase.setting.regularisation.shear_rate < options.careful_shear_rate))
    return false;
  level.state = before;
  phase.setting.regularisation.shear_rate = options.careful_shear_rate;
  phase.tolerance = options.phase_tolerance;
  return run(newton, phase, level) && lower_shear_rate(newton, options, options.tolerance, level);
}

// Flat, or that of the neighbour.
SurfaceShape first_shape(const FlowProblem& problem, const FlowState* neighbour) {
  SurfaceShape shape{problem.domain, neighbour ? neighbour->surface : std::vector<double>()};
  shape.coefficient.resize(static_cast<std::size_t>(problem.moving_surface->degree) + 1, 0.0);
  restrain(shape, fem::slope_half_length(problem));
  return shape;
}

FlowSolution solve(const FlowProblem& problem, const FlowSolverOptions& options, const FlowObserver& observer,
                   const FlowState* neighbour) {
  if (const auto reason = no_steady_state(problem)) throw NotConvergedError(*reason);
  const double start = now();
  auto level = std::make_shared<fem::SolvedLevel>();
  level->problem = problem;
  level->discretisation = std::make_shared<fem::Discretisation>(problem);
  auto& d = *level->discretisation;
  auto& state = level->state;
  if (const auto* fixed = std::get_if<FixedSlope>(&problem.slope))
    state.theta = fixed->theta;
  else
    state.theta = std::get<SlopeFromMoment>(problem.slope).first_guess;
  if (problem.moving_surface && !d.move_surface(problem, first_shape(problem, neighbour)))
    throw InputError("the surface of the neighbouring flow does not fit into this mesh");
  state.solution = d.field();
  d.constraints.distribute(state.solution);
  state.solution.update_ghost_values();

  FlowReport report;
  report.start = neighbour ? "neighbour" : "cold";
  WorkClock clock;
  const auto finished = [&](bool converged) {
    report.converged = converged;
    report.seconds = now() - start;
    for (std::size_t i = 0; i < fem::work_names.size(); ++i)
      report.phases.push_back(
          {fem::work_names[i], clock.seconds(static_cast<Work>(i)), clock.times(static_cast<Work>(i))});
    return FlowSolution{report, field_of(level)};
  };
  dealii::FullMatrix<double> response;  // of what presses on a moving surface to its shape, mesh after mesh
  int first = 0;
  if (neighbour) {
    for (; !fem::fits(d, *neighbour); ++first) {
      if (first + 1 >= options.levels) throw InputError(fem::no_mesh_fits);
      clock(Work::refinement, [&] { d.refine(problem, state.solution); });
    }
    fem::take_over(*neighbour, *level);
  }
  for (int mesh = first; mesh < options.levels; ++mesh) {
    if (mesh > first)
      clock(Work::refinement, [&] {
        if (options.refined_share < 1)
          d.refine_adaptively(problem, state.solution, options.refined_share);
        else
          d.refine(problem, state.solution);
      });
    FlowSolverOptions here = options;
    if (mesh + 1 < options.levels) here.tolerance = std::max(options.tolerance, options.coarse_tolerance);
    Newton newton(problem, here, d, mesh, start, clock, report, observer);
    state.held = nullptr;
    const bool converged = mesh > first ? solve_from("refined", newton, here, *level)
                           : neighbour  ? solve_from("neighbour", newton, here, *level)
                                        : solve_cold(newton, here, *level);
    if (!converged) return finished(false);
    if (fem::holds_fields(problem)) {
      if (observer.solved_plain && mesh + 1 == options.levels)
        clock(Work::evaluation, [&] { observer.solved_plain(field_of(level)); });
      if (!settle_held(newton, here, *level, report)) return finished(false);
    }
    if (problem.moving_surface) {
      report.failure.clear();
      const fem::SurfaceSolver solver{
          .newton =
              [&] {
                return std::make_unique<Newton>(problem, here, d, mesh, start, clock, report, observer);
              },
          .solve =
              [&](Newton& again) {
                return solve_from("surface", again, here, *level) &&
                       (!fem::holds_fields(problem) || settle_held(again, here, *level, report));
              },
          .stepped = observer.surface_step,
          .tolerance = mesh + 1 < options.levels ? options.coarse_surface_tolerance : 0};
      // A coarser mesh that resolves its ends too badly to settle is still a start for the next.
      if (!fem::settle_surface(solver, *level, mesh, response, report) &&
          (mesh + 1 == options.levels || report.failure == "interrupted"))
        return finished(false);
    }
    report.failure.clear();
    if (observer.level_finished)
      clock(Work::evaluation, [&] { observer.level_finished(mesh, field_of(level)); });
  }
  return finished(true);
}

}  // namespace

FlowSolution solve_flow(const FlowProblem& problem, const FlowSolverOptions& options,
                        const FlowObserver& observer) {
  return solve(problem, options, observer, nullptr);
}

FlowSolution solve_flow_from(const FlowState& neighbour, const FlowProblem& problem,
                             const FlowSolverOptions& options, const FlowObserver& observer) {
  FlowSolution from = solve(problem, options, observer, &neighbour);
  if (from.report.converged || from.report.failure == "interrupted") return from;

  FlowSolution cold = solve(problem, options, observer, nullptr);
  FlowReport& report = cold.report;
  report.start = "cold, since from the neighbour: " + from.report.failure;
  report.iterations += from.report.iterations;
  report.seconds += from.report.seconds;
  report.history.insert(report.history.begin(), from.report.history.begin(), from.report.history.end());
  for (std::size_t i = 0; i < report.phases.size(); ++i) {
    report.phases[i].seconds += from.report.phases[i].seconds;
    report.phases[i].times += from.report.phases[i].times;
  }
  return cold;
}

FlowSolution solve_flow_again(const FlowField& start, const FlowProblem& problem,
                              const FlowSolverOptions& options, const FlowObserver& observer) {
  const double begun = now();
  auto level = fem::level_for(start, problem);
  FlowReport report;
  report.start = "again";
  WorkClock clock;
  Newton newton(level->problem, options, *level->discretisation, 0, begun, clock, report, observer);
  report.converged = solve_from("again", newton, options, *level) &&
                     (!fem::holds_fields(problem) || settle_held(newton, options, *level, report));
  report.seconds = now() - begun;
  return {report, field_of(level)};
}

}  // namespace drumlin
