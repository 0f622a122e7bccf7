#include "continuum/fem/flow_solver.hpp"

#include <fmt/format.h>

#include <cmath>

#include "continuum/fem/detail/direct_solver.hpp"
#include "continuum/fem/detail/kept_state.hpp"
#include "continuum/fem/detail/work_clock.hpp"
#include "coupling/exchange/errors.hpp"

namespace drumlin {
namespace {

using fem::FieldVector;
using fem::now;
using fem::Setting;
using fem::State;
using fem::Work;
using fem::WorkClock;

struct Phase {
  std::string name;
  Setting setting;
  double tolerance = 0;
};

// Newton's method on one mesh.
class Newton {
 public:
  Newton(const FlowProblem& problem, const FlowSolverOptions& options,
         const fem::Discretisation& discretisation, int level, double start_seconds, WorkClock& clock,
         FlowReport& report, const FlowObserver& observer)
      : problem_(problem),
        options_(options),
        d_(discretisation),
        level_(level),
        start_(start_seconds),
        clock_(clock),
        report_(report),
        observer_(observer),
        moment_(fem::surface_moment(problem, d_)),
        system_(d_) {
    if (problem.frame) frame_moment_ = moment_ * fem::frame_velocity(problem, d_);
    weight_norm_ = problem.density > 0 ? fem::load(d_, {0, problem.density}).l2_norm() : 0;
  }

  bool solve(const Phase& phase, State& state);
  /// On any rank.
  bool was_interrupted() const {
    return d_.sum(observer_.interrupted && observer_.interrupted() ? 1 : 0) > 0;
  }

 private:
  struct Step {
    FieldVector solution;
    double theta = 0;
    double linear_residual = 0;
  };
  Step newton_step(const State& state);
  double slope(const Phase& phase, const State& state, const Step& step, double alpha);
  double step_length(const Phase& phase, const State& state, const Step& step);
  double relative_residual() const { return system_.residual.l2_norm() / reference_; }

  const FlowProblem& problem_;
  const FlowSolverOptions& options_;
  const fem::Discretisation& d_;
  fem::DirectSolver factors_;
  int level_;
  double start_;
  WorkClock& clock_;
  FlowReport& report_;
  const FlowObserver& observer_;
  FieldVector moment_;
  fem::System system_;
  double frame_moment_ = 0;  // of the velocity that the unknown lacks in a rotating frame
  double weight_norm_ = 0;
  double reference_ = 1;
};

State moved(const State& state, const FieldVector& step, double theta_step, double alpha) {
  State next = state;
  next.solution.add(alpha, step);
  next.solution.update_ghost_values();
  next.theta += alpha * theta_step;
  return next;
}

// The slope is one more unknown, its equation (the moment) linear in the solution: two solves with the same
// factors.
Newton::Step Newton::newton_step(const State& state) {
  clock_(Work::factorisation, [&] { factors_.factorise(system_.matrix); });
  Step step{.solution = d_.field()};
  FieldVector rhs = system_.residual;
  rhs *= -1;
  step.linear_residual = clock_(Work::linear_solves, [&] { return factors_.solve(rhs, step.solution); });
  d_.homogeneous.distribute(step.solution);
  if (std::holds_alternative<SlopeFromMoment>(problem_.slope)) {
    const FieldVector by_theta =
        fem::load(d_, {problem_.density * std::cos(state.theta), problem_.density * std::sin(state.theta)});
    FieldVector response = d_.field();
    step.linear_residual =
        std::max(step.linear_residual,
                 clock_(Work::linear_solves, [&] { return factors_.solve(by_theta, response); }));
    d_.homogeneous.distribute(response);
    step.theta = -(moment_ * state.solution + moment_ * step.solution + frame_moment_) / (moment_ * response);
    step.solution.add(step.theta, response);
  }
  step.solution.update_ghost_values();
  return step;
}

double Newton::slope(const Phase& phase, const State& state, const Step& step, double alpha) {
  fem::assemble_residual(problem_, d_, phase.setting, moved(state, step.solution, step.theta, alpha),
                         system_);
  double sum = 0;
  for (std::size_t i = 0; i < d_.is_velocity.size(); ++i)
    if (d_.is_velocity[i]) sum += system_.residual.local_element(i) * step.solution.local_element(i);
  return d_.sum(sum);
}

// Where the slope R(u + alpha du).du has fallen well below its start: the residual norm would ask for
// needlessly short steps, since stiff, nearly rigid parts dominate it.
double Newton::step_length(const Phase& phase, const State& state, const Step& step) {
  const double start = slope(phase, state, step, 0);
  double low = 0, at_low = start, alpha = 1, best = 1, best_slope = INFINITY;
  double high = 0, at_high = 0;
  for (int trial = 0; trial < 8; ++trial) {
    const double here = slope(phase, state, step, alpha);
    if (std::isfinite(here) && std::abs(here) < best_slope) best_slope = std::abs(here), best = alpha;
    if (std::isfinite(here) && std::abs(here) <= 0.5 * std::abs(start)) break;
    if (!std::isfinite(here) || here * start < 0)
      high = alpha, at_high = here;
    else
      low = alpha, at_low = here;
    if (high == 0) break;  // the slope has not changed sign by alpha = 1: take the whole step
    const double secant =
        std::isfinite(at_high) ? low + (high - low) * at_low / (at_low - at_high) : 0.5 * high;
    alpha = std::clamp(secant, low + 0.1 * (high - low), low + 0.7 * (high - low));
  }
  return best;
}

bool Newton::solve(const Phase& phase, State& state) {
  IterationReport line{.level = level_,
                       .phase = phase.name,
                       .shear_rate = phase.setting.regularisation.shear_rate,
                       .pressure_share = phase.setting.pressure.share};
  clock_(Work::assembly, [&] { fem::assemble_tangent(problem_, d_, phase.setting, state, system_); });
  if (weight_norm_ > 0)
    reference_ = weight_norm_;
  else
    reference_ = std::max(1e-300, fem::nodal_forces(problem_, d_, phase.setting, state).l2_norm());
  for (int iteration = 1; iteration <= options_.max_iterations; ++iteration) {
    if (was_interrupted()) {
      report_.failure = "interrupted";
      return false;
    }
    Step step;
    try {
      step = newton_step(state);
    } catch (const NotConvergedError& error) {  // a singular tangent: a smaller step in eps may still do
      report_.failure = fmt::format("{}, in phase '{}'", error.what(), phase.name);
      return false;
    }
    if (!(step.linear_residual <= options_.linear_tolerance)) {
      report_.failure =
          fmt::format("linear solve: true relative residual {:.2e} after refinement, in phase '{}'",
                      step.linear_residual, phase.name);
      return false;
    }
    const double alpha = clock_(Work::step_length, [&] { return step_length(phase, state, step); });
    FieldVector taken = step.solution;
    taken *= alpha;
    taken.update_ghost_values();
    state.dual = fem::advanced_dual(d_, phase.setting.regularisation, state, taken);
    state = moved(state, step.solution, step.theta, alpha);
    clock_(Work::assembly, [&] { fem::assemble_tangent(problem_, d_, phase.setting, state, system_); });

    line.iteration = iteration;
    line.residual = relative_residual();
    line.step_length = alpha;
    line.step_size = taken.l2_norm() / state.solution.l2_norm();
    line.linear_residual = step.linear_residual;
    line.theta = state.theta;
    line.seconds = now() - start_;
    report_.history.push_back(line);
    report_.residual = line.residual;
    ++report_.iterations;
    if (observer_.iteration) observer_.iteration(line);
    if (!std::isfinite(line.residual)) break;
    if (line.residual <= phase.tolerance) return true;
  }
  report_.failure = fmt::format(
      "mesh {}, phase '{}' (eps = {:.3g}, true pressure {:.2f}): residual {:.3e} after {} iterations, "
      "tolerance {:.1e}, last step {:.2e}",
      level_, phase.name, line.shear_rate, line.pressure_share, line.residual, line.iteration,
      phase.tolerance, line.step_size);
  return false;
}

Setting final_setting(const FlowProblem& problem, double theta) {
  return {problem.law,
          problem.regularisation,
          {1, problem.surface_pressure, problem.density * std::cos(theta)},
          std::nullopt};
}

// Everything before eps goes down on the first mesh: from a Newtonian fluid to the law at a large eps, where
// it is nearly one.
std::vector<Phase> cold_phases(const FlowProblem& problem, const FlowSolverOptions& options, double theta) {
  Setting setting = final_setting(problem, theta);
  if (std::holds_alternative<NewtonianLaw>(problem.law)) return {{"newtonian", setting, options.tolerance}};
  setting.regularisation.shear_rate = std::max(problem.regularisation.shear_rate, options.start_shear_rate);
  const Setting newtonian{NewtonianLaw{1}, setting.regularisation, setting.pressure, std::nullopt};
  std::vector<Phase> list = {{"newtonian", newtonian, options.phase_tolerance}};
  for (const double share : options.pressure_shares) {
    setting.pressure.share = share;
    list.push_back({share == 0 ? "hydrostatic" : "pressure", setting, options.phase_tolerance});
  }
  return list;
}

bool run(Newton& newton, const Phase& phase, fem::SolvedLevel& level) {
  level.setting = phase.setting;
  level.state.dual = fem::dual_of(*level.discretisation, phase.setting.regularisation, level.state.solution);
  return newton.solve(phase, level.state);
}

// eps downwards; where a step fails it is halved (in ln eps) from the last solution that converged.
bool lower_shear_rate(Newton& newton, const FlowSolverOptions& options, double tolerance,
                      fem::SolvedLevel& level) {
  const double last = level.problem.regularisation.shear_rate;
  double eps = level.setting.regularisation.shear_rate, factor = options.shear_rate_factor;
  Phase phase{"shear rate", level.setting, options.phase_tolerance};
  while (eps > last) {
    double next = std::max(last, eps * factor);
    if (next < 1.5 * last) next = last;
    phase.setting.regularisation.shear_rate = next;
    phase.tolerance = next == last ? tolerance : options.phase_tolerance;
    const State before = level.state;
    if (run(newton, phase, level)) {
      eps = next;
      continue;
    }
    factor = std::sqrt(factor);
    if (factor > 0.8 || newton.was_interrupted()) return false;
    level.state = before;
  }
  return true;
}

// From slow flow to full inertia; a step that fails is halved.
bool raise_inertia(Newton& newton, const FlowSolverOptions& options, fem::SolvedLevel& level) {
  double share = 0, step = 1;
  while (share < 1) {
    const double next = std::min(1.0, share + step);
    Phase phase{"inertia", level.setting, next < 1 ? options.phase_tolerance : options.tolerance};
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
  auto list = cold_phases(level.problem, options, level.state.theta);
  const double tolerance = level.problem.inertia ? options.phase_tolerance : options.tolerance;
  if (list.back().setting.regularisation.shear_rate <= level.problem.regularisation.shear_rate)
    list.back().tolerance = tolerance;
  for (const Phase& phase : list)
    if (!run(newton, phase, level)) return false;
  return lower_shear_rate(newton, options, tolerance, level) &&
         (!level.problem.inertia || raise_inertia(newton, options, level));
}

// What others look at is in the frame of the laboratory.
FlowField field_of(const std::shared_ptr<fem::SolvedLevel>& level) {
  if (!level->problem.frame) return FlowField(level);
  auto seen = std::make_shared<fem::SolvedLevel>(*level);
  seen->state.solution += fem::frame_velocity(level->problem, *level->discretisation);
  seen->state.solution.update_ghost_values();
  seen->problem.frame = std::nullopt;
  return FlowField(seen);
}

// From a solution nearby: that of a coarser mesh ("refined") or of another problem ("neighbour").
bool solve_from(const std::string& name, Newton& newton, const FlowSolverOptions& options,
                fem::SolvedLevel& level) {
  const State before = level.state;
  Phase phase{name, final_setting(level.problem, before.theta), options.tolerance};
  if (level.problem.inertia) phase.setting.inertia = fem::InertiaSetting{};
  if (run(newton, phase, level)) return true;
  if (newton.was_interrupted() || !(phase.setting.regularisation.shear_rate < options.careful_shear_rate))
    return false;
  level.state = before;
  phase.setting.regularisation.shear_rate = options.careful_shear_rate;
  phase.tolerance = options.phase_tolerance;
  return run(newton, phase, level) && lower_shear_rate(newton, options, options.tolerance, level);
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
  int first = 0;
  if (neighbour) {
    for (; !fem::fits(d, *neighbour); ++first) {
      if (first + 1 >= options.levels)
        throw InputError(
            "the state of the neighbouring flow lies on none of the meshes of this one: geometry, fill and "
            "mesh have to be the same, speed and law may differ");
      clock(Work::refinement, [&] { d.refine(problem, state.solution); });
    }
    fem::take_over(*neighbour, *level);
  }
  for (int mesh = first; mesh < options.levels; ++mesh) {
    if (mesh > first) clock(Work::refinement, [&] { d.refine(problem, state.solution); });
    FlowSolverOptions here = options;
    if (mesh + 1 < options.levels) here.tolerance = std::max(options.tolerance, options.coarse_tolerance);
    Newton newton(problem, here, d, mesh, start, clock, report, observer);
    const bool converged = mesh > first ? solve_from("refined", newton, here, *level)
                           : neighbour  ? solve_from("neighbour", newton, here, *level)
                                        : solve_cold(newton, here, *level);
    if (!converged) return finished(false);
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

}  // namespace drumlin
