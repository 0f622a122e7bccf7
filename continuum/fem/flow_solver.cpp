#include "continuum/fem/flow_solver.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "continuum/fem/detail/kept_state.hpp"
#include "continuum/fem/detail/newton.hpp"
#include "continuum/fem/detail/picard.hpp"
#include "continuum/fem/detail/surface_iteration.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum {
namespace {

using fem::field_of;
using fem::final_setting;
using fem::lower_shear_rate;
using fem::Newton;
using fem::now;
using fem::Phase;
using fem::run;
using fem::Setting;
using fem::solve_held_fields;
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

Phase last_phase(const std::string& name, const FlowProblem& problem, const FlowSolverOptions& options) {
  Phase phase{name, final_setting(problem), options.tolerance};
  if (problem.inertia) phase.setting.inertia = fem::InertiaSetting{};
  return phase;
}

// From a solution nearby: that of a coarser mesh ("refined") or of another problem ("neighbour").
bool solve_from(const std::string& name, Newton& newton, const FlowSolverOptions& options,
                fem::SolvedLevel& level) {
  const State before = level.state;
  Phase phase = last_phase(name, level.problem, options);
  phase.starts_nearby = true;
  if (run(newton, phase, level)) return true;
  if (newton.was_interrupted() || !(phase.setting.regularisation.shear_rate < options.careful_shear_rate))
    return false;
  level.state = before;
  phase.setting.regularisation.shear_rate = options.careful_shear_rate;
  phase.tolerance = options.phase_tolerance;
  phase.starts_nearby = false;
  return run(newton, phase, level) && lower_shear_rate(newton, options, options.tolerance, level);
}

// Flat, or that of the neighbour.
SurfaceShape first_shape(const FlowProblem& problem, const FlowState* neighbour) {
  SurfaceShape shape{problem.domain, neighbour ? neighbour->surface : std::vector<double>()};
  shape.coefficient.resize(static_cast<std::size_t>(problem.moving_surface->degree) + 1, 0.0);
  restrain(shape, fem::slope_half_length(problem));
  return shape;
}

double first_theta(const FlowProblem& problem) {
  const auto* fixed = std::get_if<FixedSlope>(&problem.slope);
  return fixed ? fixed->theta : std::get<SlopeFromMoment>(problem.slope).first_guess;
}

std::shared_ptr<fem::SolvedLevel> coarsest_level(const FlowProblem& problem, const FlowState* neighbour) {
  auto level = std::make_shared<fem::SolvedLevel>();
  level->problem = problem;
  level->discretisation = std::make_shared<fem::Discretisation>(problem);
  auto& d = *level->discretisation;
  level->state.theta = first_theta(problem);
  if (problem.moving_surface && !d.move_surface(problem, first_shape(problem, neighbour)))
    throw InputError("the surface of the neighbouring flow does not fit into this mesh");
  level->state.solution = d.field();
  d.constraints.distribute(level->state.solution);
  level->state.solution.update_ghost_values();
  return level;
}

// Solved as far as a flow needs whose surface will move.
FlowSolverOptions loosely_solved(const FlowProblem& problem, FlowSolverOptions options) {
  options.picard_tolerance = std::max(options.picard_tolerance, options.loose_picard_tolerance);
  options.tolerance =
      std::max(options.tolerance, problem.memory ? options.loose_memory_tolerance : options.loose_tolerance);
  return options;
}

// One solve from mesh to mesh: cold, or from the state of another flow.
class Continuation {
 public:
  // `first`: from the neighbour's mesh on, or from the next one.
  enum class First { same, finer };

  Continuation(const FlowProblem& problem, const FlowSolverOptions& options, const FlowObserver& observer,
               const FlowState* neighbour, First first = First::same)
      : problem_(problem),
        options_(options),
        observer_(observer),
        neighbour_(neighbour),
        first_(first),
        level_(coarsest_level(problem, neighbour)) {
    report_.start = neighbour ? "neighbour" : "cold";
  }

  FlowSolution solution() {
    const int start = neighbour_ ? take_over_neighbour() : 0;
    for (int mesh = first_ == First::finer ? start + 1 : start; mesh < options_.levels; ++mesh) {
      if (mesh > start) refine();
      if (!solve_mesh(mesh, mesh > start ? "refined" : neighbour_ ? "neighbour" : nullptr))
        return finished(false);
      report_.failure.clear();
      if (observer_.level_finished)
        clock_(Work::evaluation, [&] { observer_.level_finished(mesh, field_of(level_)); });
    }
    return finished(true);
  }

 private:
  // Onto the mesh that the neighbour fits, the first or one beyond the last; its number.
  int take_over_neighbour() {
    const int mesh = clock_(Work::refinement, [&] { return fem::refine_to(*neighbour_, options_, *level_); });
    fem::take_over(*neighbour_, *level_);
    options_.levels = first_ == First::finer ? mesh + 2 : std::max(options_.levels, mesh + 1);
    return mesh;
  }

  void refine() {
    clock_(Work::refinement, [&] {
      if (options_.refined_share < 1)
        discretisation().refine_adaptively(problem_, level_->state.solution, options_.refined_share);
      else
        discretisation().refine(problem_, level_->state.solution);
    });
  }

  // `start`: the phase that begins; null: cold.
  bool solve_mesh(int mesh, const char* start) {
    FlowSolverOptions here = options_;
    if (!is_last(mesh)) here.tolerance = std::max(options_.tolerance, options_.coarse_tolerance);
    const FlowSolverOptions whole = here;
    if (problem_.moving_surface) here = loosely_solved(problem_, here);
    Newton newton(problem_, here, discretisation(), mesh, begun_, clock_, report_, observer_);
    level_->state.held = nullptr;
    if (problem_.memory && start != nullptr && solve_remembering(newton, start, here))
      return !problem_.moving_surface || move_surface(mesh, whole, here);
    if (!(start == nullptr ? solve_cold(newton, here, *level_) : solve_from(start, newton, here, *level_)))
      return false;
    if (fem::holds_fields(problem_)) {
      if (observer_.solved_plain && is_last(mesh) && !problem_.memory)
        clock_(Work::evaluation, [&] { observer_.solved_plain(field_of(level_)); });
      if (!solve_held_fields(newton, here, *level_, report_)) return false;
    }
    return !problem_.moving_surface || move_surface(mesh, whole, here);
  }

  // From a flow nearby what the material remembers is at hand: it follows from that flow. The state is as it
  // was where that fails.
  bool solve_remembering(Newton& newton, const std::string& start, const FlowSolverOptions& here) {
    const State before = level_->state;
    level_->setting = final_setting(problem_);
    if (problem_.inertia) level_->setting.inertia = fem::InertiaSetting{};
    try {
      level_->state.held =
          fem::held_from(problem_, discretisation(), before, {.linear_tolerance = here.linear_tolerance});
      if (solve_from(start, newton, here, *level_) && solve_held_fields(newton, here, *level_, report_))
        return true;
    } catch (const NotConvergedError& error) {
      report_.failure = error.what();
    }
    level_->state = before;
    return false;
  }

  bool move_surface(int mesh, const FlowSolverOptions& whole, const FlowSolverOptions& loose) {
    report_.failure.clear();
    FlowSolverOptions here = whole;
    if (problem_.memory && !is_last(mesh)) {  // memory is but a start for the next, and a part of its error
      here = loose;
      here.picard_tolerance = std::max(options_.picard_tolerance, options_.coarse_picard_tolerance);
    }
    const fem::SurfaceSolver solver{
        .newton =
            [&] {
              return std::make_unique<Newton>(problem_, here, discretisation(), mesh, begun_, clock_, report_,
                                              observer_);
            },
        .solve =
            [&](Newton& again, fem::Settling settling) {
              FlowSolverOptions how = settling == fem::Settling::loose ? loose : here;
              if (settling == fem::Settling::fine) how.picard_tolerance *= options_.fine_picard_share;
              // A surface that has gone too far goes half as far: a larger eps would hardly ever help.
              return run(again, last_phase("surface", problem_, how), *level_) &&
                     (!fem::holds_fields(problem_) || solve_held_fields(again, how, *level_, report_));
            },
        .first = fem::Settling::loose,
        .stepped = observer_.surface_step,
        .tolerance = is_last(mesh) ? 0 : options_.coarse_surface_tolerance};
    // A coarser mesh whose ends are resolved too badly to converge is still a start for the next.
    return fem::solve_surface(solver, *level_, mesh, report_) || (!is_last(mesh) && !report_.interrupted);
  }

  FlowSolution finished(bool converged) {
    report_.converged = converged;
    discretisation().forget_systems();
    report_.seconds = now() - begun_;
    for (std::size_t i = 0; i < fem::work_names.size(); ++i)
      report_.phases.push_back(
          {fem::work_names[i], clock_.seconds(static_cast<Work>(i)), clock_.times(static_cast<Work>(i))});
    return {report_, field_of(level_)};
  }

  fem::Discretisation& discretisation() { return *level_->discretisation; }
  bool is_last(int mesh) const { return mesh + 1 == options_.levels; }

  const double begun_ = now();
  const FlowProblem& problem_;
  FlowSolverOptions options_;
  const FlowObserver& observer_;
  const FlowState* neighbour_;
  const First first_;
  std::shared_ptr<fem::SolvedLevel> level_;
  FlowReport report_;
  WorkClock clock_;
};

FlowSolution solve(const FlowProblem& problem, const FlowSolverOptions& options, const FlowObserver& observer,
                   const FlowState* neighbour) {
  if (const auto reason = no_steady_state(problem)) throw NotConvergedError(*reason);
  return Continuation(problem, options, observer, neighbour).solution();
}

}  // namespace

std::optional<double> slope_of(const IterationReport& line) {
  if (line.rejected || !(std::abs(line.theta) < 0.5 * std::numbers::pi)) return std::nullopt;
  return line.theta;
}

FlowSolution solve_flow(const FlowProblem& problem, const FlowSolverOptions& options,
                        const FlowObserver& observer) {
  return solve(problem, options, observer, nullptr);
}

FlowSolution solve_flow_from(const FlowState& neighbour, const FlowProblem& problem,
                             const FlowSolverOptions& options, const FlowObserver& observer) {
  FlowSolution from = solve(problem, options, observer, &neighbour);
  if (from.report.converged || from.report.interrupted) return from;

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

FlowSolution solve_flow_finer(const FlowSolution& coarser, const FlowProblem& problem,
                              const FlowSolverOptions& options, const FlowObserver& observer) {
  const FlowState state = coarser.field.state();
  FlowSolution finer =
      Continuation(problem, options, observer, &state, Continuation::First::finer).solution();
  const FlowReport &before = coarser.report, after = std::move(finer.report);
  FlowReport& whole = finer.report = before;
  whole.converged = after.converged;
  whole.failure = after.failure;
  whole.residual = after.residual;
  whole.iterations += after.iterations;
  whole.meshes = after.meshes;
  whole.picard_updates = after.picard_updates;
  whole.picard_change = after.picard_change;
  whole.seconds += after.seconds;
  for (IterationReport line : after.history) {
    line.seconds += before.seconds;
    whole.history.push_back(line);
  }
  for (std::size_t i = 0; i < whole.phases.size(); ++i) {
    whole.phases[i].seconds += after.phases[i].seconds;
    whole.phases[i].times += after.phases[i].times;
  }
  whole.surface_steps.insert(whole.surface_steps.end(), after.surface_steps.begin(),
                             after.surface_steps.end());
  return finer;
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
                     (!fem::holds_fields(problem) || solve_held_fields(newton, options, *level, report));
  report.seconds = now() - begun;
  return {report, field_of(level)};
}

}  // namespace drumlin::continuum
