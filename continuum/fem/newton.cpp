#include "continuum/fem/detail/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "continuum/fem/detail/local_steps.hpp"
#include "continuum/fem/detail/step_length.hpp"
#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum::fem {
namespace {

// A residual above the weight and so many times as large as the least so far leads to no solution.
constexpr double hopeless_growth = 10;

// True relative residual of a solve that asks for no refinement: below every tolerance on the flow.
constexpr double enough = 1e-9;

// Of the fluidity, relative: far below what the residual of the momentum can tell, and what suffices to
// compare step lengths.
constexpr double settled = 1e-9, nearly_settled = 1e-4;
// On the step of ln g from which it settles; g changes by seven at most.
constexpr double largest_fluidity_step = 2;

// Share of the velocities that a step moves, below which what stands out settles locally: a place settles to
// the flow around it, which a large step has not found yet.
constexpr double small_step = 0.05;

// Newton's method makes no progress after so many steps in a row of which so little was taken. Local steps
// can keep it there, and so can a start too far off.
constexpr int most_short_steps = 6;
constexpr double short_step = 0.3;

std::string unsettled(const Phase& phase) {
  return fmt::format("the fluidity of a flow could not be found, in phase '{}'", phase.name);
}

}  // namespace

double Newton::solved(const FieldVector& rhs, FieldVector& solution) {
  return clock_(Work::linear_solves, [&] { return factors_.solve(rhs, solution, enough); });
}

// A state that has settled at a given slope, at that without moment, by the response to the slope of the last
// step.
State Newton::without_moment(const State& state) const {
  if (!std::holds_alternative<SlopeFromMoment>(problem_.slope)) return state;
  const FieldVector& response = *response_;
  return moved(state, response, 1, -(moment_ * state.solution + frame_moment_) / (moment_ * response));
}

// The slope is one more unknown, its equation (the moment) linear in the solution: two solves with one
// matrix, one of them in factorise().
Newton::Step Newton::step_with_factors(const State& state) {
  Step step{.solution = d_.field()};
  FieldVector rhs = system_.residual;
  rhs *= -1;
  step.linear_residual = std::max(response_error_, solved(rhs, step.solution));
  d_.homogeneous.distribute(step.solution);
  if (response_) {
    step.theta =
        -(moment_ * state.solution + moment_ * step.solution + frame_moment_) / (moment_ * *response_);
    step.solution.add(step.theta, *response_);
  }
  step.solution.update_ghost_values();
  return step;
}

void Newton::factorise(const State& state) {
  clock_(Work::factorisation, [&] { factors_.factorise(system_.matrix); });
  if (!std::holds_alternative<SlopeFromMoment>(problem_.slope)) return;
  const FieldVector by_theta =
      load(d_, {problem_.density * std::cos(state.theta), problem_.density * std::sin(state.theta)});
  if (!response_) response_.emplace(d_.field());
  response_error_ = solved(by_theta, *response_);
  d_.homogeneous.distribute(*response_);
}

void Newton::linearise(const Setting& setting, const State& state) {
  clock_(Work::assembly, [&] { assemble_tangent(problem_, d_, setting, state, system_); });
  factorise(state);
}

State Newton::corrected(const Setting& setting, const State& state) {
  moment_ = surface_moment(problem_, d_);
  if (problem_.frame) frame_moment_ = moment_ * frame_velocity(problem_, d_);
  clock_(Work::assembly, [&] { assemble_residual(problem_, d_, setting, state, system_); });
  const Step step = step_with_factors(state);
  if (!(step.linear_residual <= options_.linear_tolerance))
    throw NotConvergedError(fmt::format("linear solve: true relative residual {:.2e}", step.linear_residual));
  return moved(state, step.solution, step.theta, 1);
}

// Over the velocities alone.
double Newton::product(const FieldVector& a, const FieldVector& b) const {
  double sum = 0;
  for (std::size_t i = 0; i < d_.is_velocity.size(); ++i)
    if (d_.is_velocity[i]) sum += a.local_element(i) * b.local_element(i);
  return d_.sum(sum);
}

// Leaves the residual there in the system.
double Newton::slope(const Phase& phase, const State& state, const Step& step, double alpha) {
  State there = moved(state, step.solution, step.theta, alpha);
  if (!settle(phase, nearly_settled, there)) return NAN;
  assemble_residual(problem_, d_, phase.setting, there, system_);
  return product(system_.residual, step.solution);
}

// From a state whose residual is assembled to one whose is, that may have moved where few unknowns held most
// of it. A state with a larger residual of all unknowns is not taken.
void Newton::settle_locally(const Phase& phase, State& state) {
  const auto assemble = [&] {
    clock_(Work::assembly, [&] { assemble_residual(problem_, d_, phase.setting, state, system_); });
  };
  const double before = relative_residual();
  if (before <= phase.tolerance) return;
  std::optional<State> settled_state = clock_(Work::local_steps, [&] {
    return locally_settled(problem_, d_, phase.setting, state, system_.residual);
  });
  if (!settled_state) return;
  std::swap(state, *settled_state);
  assemble();
  if (!(relative_residual() <= before)) {
    std::swap(state, *settled_state);
    assemble();
    return;
  }
  has_settled_locally_ = true;
  if (relative_residual() > phase.tolerance || !response_) return;
  // No step follows that would see to the moment.
  state = without_moment(state);
  assemble();
}

// Empty where the linear solve fails; the report says why.
std::optional<Newton::Step> Newton::newton_step(const Phase& phase, const State& state) {
  try {
    factorise(state);
    Step step = step_with_factors(state);
    if (fluidity_) fluidity_->limit(largest_fluidity_step, step.solution);
    if (step.linear_residual <= options_.linear_tolerance) return step;
    report_.failure = fmt::format("linear solve: true relative residual {:.2e}, in phase '{}'",
                                  step.linear_residual, phase.name);
  } catch (const NotConvergedError& error) {  // a singular tangent: a smaller step in eps may still do
    report_.failure = fmt::format("{}, in phase '{}'", error.what(), phase.name);
  }
  return std::nullopt;
}

// Moves the state, lets it settle where few unknowns are far off, assembles, and fills in what the step did.
// False where the fluidity does not settle.
bool Newton::take(const Phase& phase, const Step& step, State& state, IterationReport& line) {
  const StepLength length = clock_(Work::step_length, [&] {
    return step_length(product(system_.residual, step.solution),
                       [&](double share) { return slope(phase, state, step, share); });
  });
  const double alpha = length.share;
  FieldVector taken = step.solution;
  taken *= alpha;
  taken.update_ghost_values();
  state.dual = advanced_dual(d_, phase.setting.regularisation, state, taken);
  state = moved(state, step.solution, step.theta, alpha);
  if (!clock_(Work::assembly, [&] { return settle(phase, settled, state); })) return false;
  line.step_size = taken.l2_norm() / state.solution.l2_norm();
  const bool is_small =
      product(taken, taken) < small_step * small_step * product(state.solution, state.solution);
  bool is_last = false;  // no step follows that would need a tangent
  if (phase.locally && is_small && !fluidity_) {
    if (!length.asked_last) assemble_residual(problem_, d_, phase.setting, state, system_);
    settle_locally(phase, state);
    is_last = relative_residual() <= phase.tolerance;
  }
  if (!is_last)
    clock_(Work::assembly, [&] { assemble_tangent(problem_, d_, phase.setting, state, system_); });
  line.residual = relative_residual();
  line.step_length = alpha;
  line.linear_residual = step.linear_residual;
  line.theta = state.theta;
  line.seconds = now() - start_;
  return true;
}

void Newton::record(const IterationReport& line) {
  report_.history.push_back(line);
  report_.residual = line.residual;
  ++report_.iterations;
  if (observer_.iteration) observer_.iteration(line);
}

bool Newton::solve(const Phase& phase, State& state) {
  const auto before = static_cast<std::ptrdiff_t>(report_.history.size());
  if (iterate(phase, state)) {
    // A whole turn more is the same slope.
    if (std::abs(state.theta) > std::numbers::pi)
      state.theta = std::remainder(state.theta, 2 * std::numbers::pi);
    return true;
  }
  const std::span in_vain(report_.history.begin() + before, report_.history.end());
  for (IterationReport& line : in_vain) line.rejected = true;
  if (observer_.rejected && !in_vain.empty()) observer_.rejected(in_vain.back());
  return false;
}

bool Newton::iterate(const Phase& phase, State& state) {
  const bool settles_first = phase.starts_nearby && phase.locally && !fluidity_;
  has_settled_locally_ = false;
  report_.failure.clear();
  IterationReport line{
      .level = level_, .phase = phase.name, .shear_rate = phase.setting.regularisation.shear_rate};
  if (!clock_(Work::assembly, [&] { return settle(phase, settled, state); })) {
    report_.failure = unsettled(phase);
    return false;
  }
  if (weight_norm_ > 0)
    reference_ = weight_norm_;
  else
    reference_ = std::max(1e-300, nodal_forces(problem_, d_, phase.setting, state).l2_norm());
  if (settles_first) {
    clock_(Work::assembly, [&] { assemble_residual(problem_, d_, phase.setting, state, system_); });
    settle_locally(phase, state);
  }
  clock_(Work::assembly, [&] { assemble_tangent(problem_, d_, phase.setting, state, system_); });
  int short_steps = 0;
  double least = INFINITY;
  for (line.iteration = 1; line.iteration <= options_.max_iterations; ++line.iteration) {
    if (was_interrupted()) {
      report_.failure = "interrupted";
      report_.interrupted = true;
      return false;
    }
    const auto step = newton_step(phase, state);
    if (!step) return false;
    if (!take(phase, *step, state, line)) {
      report_.failure = unsettled(phase);
      return false;
    }
    record(line);
    least = std::min(least, line.residual);
    if (!(line.residual <= std::max(1.0, hopeless_growth * least))) break;
    if (line.residual <= phase.tolerance) return true;
    short_steps = line.step_length < short_step ? short_steps + 1 : 0;
    if ((has_settled_locally_ || phase.gives_up) && short_steps == most_short_steps) break;
  }
  report_.failure = fmt::format(
      "mesh {}, phase '{}' (eps = {:.3g}): residual {:.3e} after {} iterations, "
      "tolerance {:.1e}, last step {:.2e}",
      level_, phase.name, line.shear_rate, line.residual, std::min(line.iteration, options_.max_iterations),
      phase.tolerance, line.step_size);
  return false;
}

Setting final_setting(const FlowProblem& problem) {
  return {problem.law, problem.regularisation, std::nullopt};
}

bool run(Newton& newton, const Phase& phase, SolvedLevel& level) {
  level.setting = phase.setting;
  if (!phase.keeps_dual)
    level.state.dual = dual_of(*level.discretisation, phase.setting.regularisation, level.state.solution);
  const State before = level.state;
  if (newton.solve(phase, level.state)) return true;
  if (!newton.has_settled_locally() || newton.was_interrupted()) return false;
  level.state = before;
  Phase plain = phase;
  plain.locally = false;
  plain.name += " plain";  // no comma: it stands in a table
  return newton.solve(plain, level.state);
}

FlowField field_of(const std::shared_ptr<SolvedLevel>& level) {
  if (!level->problem.frame) return FlowField(level);
  auto seen = std::make_shared<SolvedLevel>(*level);
  seen->state.solution += frame_velocity(level->problem, *level->discretisation);
  seen->state.solution.update_ghost_values();
  seen->problem.frame = std::nullopt;
  return FlowField(seen);
}

std::shared_ptr<SolvedLevel> level_for(const FlowField& start, const FlowProblem& problem) {
  auto level = std::make_shared<SolvedLevel>(start.level());
  level->problem = problem;
  level->problem.frame = std::nullopt;
  auto& d = *level->discretisation;
  d.constrain(level->problem);
  d.constraints.distribute(level->state.solution);
  level->state.solution.update_ghost_values();
  return level;
}

}  // namespace drumlin::continuum::fem
