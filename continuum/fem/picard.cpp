#include "continuum/fem/detail/picard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::continuum::fem {
namespace {

constexpr int memory_rise = 4;              // Picard updates
constexpr double memory_per_velocity = 50;  // of the change of A, whose axes are noise where nothing shears
constexpr double update_tolerance = 1e-6;   // of the residual, between updates of the memory

// Relative change of the velocity, or of the slope where that is larger.
double change_between(const Discretisation& d, const State& before, const State& after) {
  double change = 0, size = 0;
  for (std::size_t i = 0; i < d.is_velocity.size(); ++i) {
    if (!d.is_velocity[i]) continue;
    const double here = after.solution.local_element(i), step = here - before.solution.local_element(i);
    change += step * step;
    size += here * here;
  }
  const double tilt = std::abs(after.theta - before.theta);
  return std::max(std::sqrt(d.sum(change) / d.sum(size)), tilt > 0 ? tilt / std::abs(after.theta) : 0);
}

std::string phase_name(const FlowProblem& problem) {
  if (problem.memory) return "memory";
  return problem.turned ? "k" : "nonlocal";
}

// The first solve starts at a larger eps: with k the stress jumps by up to (k - 1)/(2 mu) of itself.
bool enter(Newton& newton, const FlowSolverOptions& options, const Setting& last, SolvedLevel& level) {
  const double eps = level.problem.regularisation.shear_rate;
  Phase start{phase_name(level.problem), last, options.phase_tolerance};
  start.setting.regularisation.shear_rate = std::max(eps, options.careful_shear_rate);
  if (start.setting.regularisation.shear_rate <= eps) start.tolerance = options.tolerance;
  return run(newton, start, level) && lower_shear_rate(newton, options, options.tolerance, level);
}

}  // namespace

bool lower_shear_rate(Newton& newton, const FlowSolverOptions& options, double tolerance,
                      SolvedLevel& level) {
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

bool solve_held_fields(Newton& newton, const FlowSolverOptions& options, SolvedLevel& level,
                       FlowReport& report) {
  const Setting last = level.setting;
  const bool enters = !level.state.held, remembers = level.problem.memory.has_value();
  // The weight of the memory rises over the first updates; between updates Newton's method goes as far as
  // they need.
  const int rise = enters && remembers ? memory_rise : 1;
  const double tolerance = remembers ? std::max(options.tolerance, update_tolerance) : options.tolerance;
  MemoryMixing mixing;
  double share = 1, last_change = INFINITY;
  for (report.picard_updates = 1; report.picard_updates <= options.max_picard_updates;
       ++report.picard_updates) {
    const bool first = enters && report.picard_updates == 1, rises = report.picard_updates <= rise;
    const State before = level.state;
    if (rises) mixing.forget();
    try {
      level.state.held =
          held_from(level.problem, *level.discretisation, before,
                    {.share = share,
                     .memory_share = rises ? static_cast<double>(report.picard_updates) / rise : 1,
                     .mixing = remembers ? &mixing : nullptr,
                     .linear_tolerance = options.linear_tolerance});
    } catch (const NotConvergedError& error) {
      report.failure = error.what();
      return false;
    }
    if (!(first ? enter(newton, options, last, level)
                : run(newton, {phase_name(level.problem), last, tolerance}, level)))
      return false;
    report.picard_change = change_between(*level.discretisation, before, level.state) /
                           (remembers ? MemoryMixing::share : share);
    // A velocity that hardly changes is no proof: the mix may have come back to where it was.
    const bool remembers_the_same =
        !remembers || mixing.change() <= memory_per_velocity * options.picard_tolerance;
    if (!first && (!rises || rise == 1) && report.picard_change <= options.picard_tolerance &&
        remembers_the_same)
      return tolerance == options.tolerance ||
             run(newton, {phase_name(level.problem), last, options.tolerance}, level);
    // Smaller updates where whole ones do not converge: the turn of the axes depends on derivatives of
    // D, the stress on the turn, so that an update may overshoot, the more the finer the mesh.
    if (!remembers && report.picard_change > 0.8 * last_change) share = std::max(0.5 * share, 1.0 / 16);
    last_change = report.picard_change;
  }
  report.failure = fmt::format(
      "the Picard iteration for the fields that the law takes from the flow does not converge: update {} "
      "still "
      "moves the flow by {:.2e}, tolerance "
      "{:.1e}",
      options.max_picard_updates, report.picard_change, options.picard_tolerance);
  return false;
}

}  // namespace drumlin::continuum::fem
