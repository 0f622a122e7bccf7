#include "particles/solver/contact_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/exchange/errors.hpp"
#include "particles/contact/problems.hpp"
#include "particles/solver/lane_sweeps.hpp"
#include "particles/solver/momentum.hpp"

namespace drumlin {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Drives sweeps until the judge is content. `after_sweep` may move r and the state on, but not after the
/// last sweep.
template <class Problem, class AfterSweep>
SolveReport sweep_until_judged(const Problem& problem, const StoppingRule& rule,
                               SolverScratch<Problem>& scratch, std::vector<double>& r,
                               AfterSweep after_sweep) {
  const auto start = Clock::now();
  SolveReport report;
  r.resize(problem.q.size());
  scratch.step.resize(r.size());
  problem.W.load(scratch.state, r);
  for (;;) {
    after_sweep.before(scratch);
    const double step_squares = problem.W.sweep(problem.q, problem.mu, r, scratch.state, scratch.step);
    ++report.sweeps;
    const bool last = report.sweeps >= rule.max_sweeps;
    if (last || report.sweeps % rule.check_every == 0) {
      report.judgement = judge(problem, std::span<const double>(r), scratch.judge);
      report.seconds = seconds_since(start);
      if (!std::isfinite(step_squares) || std::isnan(report.judgement.residual))
        report.status = Status::not_finite;
      else if (report.judgement.residual <= rule.tolerance &&
               report.judgement.penetration <= rule.penetration)
        report.status = Status::converged;
      else if (last)
        report.status = Status::out_of_sweeps;
      else if (report.seconds > rule.max_seconds)
        report.status = Status::out_of_time;
      else {
        after_sweep.after(scratch, r, step_squares);
        continue;
      }
      return report;
    }
    after_sweep.after(scratch, r, step_squares);
  }
}

struct Plain {
  template <class Scratch>
  void before(Scratch&) {}
  template <class Scratch>
  void after(Scratch&, std::vector<double>&, double) {}
};

/// Fletcher-Reeves: the step of a sweep plays the negative gradient. r and the state are linear in each
/// other, so the state is carried along instead of being computed from r again.
template <class Delassus>
struct FletcherReeves {
  double previous_squares = 0;

  template <class Scratch>
  void before(Scratch& scratch) {
    scratch.state_before = scratch.state;
  }
  template <class Scratch>
  void after(Scratch& scratch, std::vector<double>& r, double step_squares) {
    auto now = Delassus::numbers(scratch.state);
    const auto then = Delassus::numbers(scratch.state_before);
    scratch.direction.resize(r.size());
    if (scratch.direction_state.size() != scratch.state.size())
      scratch.direction_state.resize(scratch.state.size());
    auto direction_state = Delassus::numbers(scratch.direction_state);
    const double beta = previous_squares > 0 ? step_squares / previous_squares : 2;
    previous_squares = step_squares;
    if (beta > 1) {  // the first sweep, or growing steps: start again along the step itself
      for (std::size_t k = 0; k < r.size(); ++k) scratch.direction[k] = scratch.step[k];
      for (std::size_t k = 0; k < now.size(); ++k) direction_state[k] = now[k] - then[k];
      return;
    }
    for (std::size_t k = 0; k < r.size(); ++k) {
      r[k] += beta * scratch.direction[k];
      scratch.direction[k] = beta * scratch.direction[k] + scratch.step[k];
    }
    for (std::size_t k = 0; k < now.size(); ++k) {
      const double swept = now[k] - then[k];
      now[k] +=
          beta * direction_state[k];  // inverse masses: their difference, hence their direction, is zero
      direction_state[k] = beta * direction_state[k] + swept;
    }
  }
};

/// Nesterov's extrapolation between sweeps. r and the state are linear in each other: both go on alike.
template <class Delassus>
struct Extrapolation {
  Momentum momentum;

  template <class Scratch>
  void before(Scratch&) {}
  template <class Scratch>
  void after(Scratch& scratch, std::vector<double>& r, double step_squares) {
    const double beta = momentum.next(step_squares);
    const auto go_on = [beta](double& now, double& then) {
      const double x = now;
      now += beta * (x - then);
      then = x;
    };
    auto& r_before = scratch.direction;
    if (beta == 0) {
      r_before = r;
      scratch.state_before = scratch.state;
      return;
    }
    for (std::size_t k = 0; k < r.size(); ++k) go_on(r[k], r_before[k]);
    auto now = Delassus::numbers(scratch.state), then = Delassus::numbers(scratch.state_before);
    for (std::size_t k = 0; k < now.size(); ++k) go_on(now[k], then[k]);
  }
};

}  // namespace

std::string to_string(Status status) {
  switch (status) {
    case Status::converged:
      return "converged";
    case Status::out_of_sweeps:
      return "out of sweeps";
    case Status::out_of_time:
      return "out of time";
    case Status::not_finite:
      return "not finite";
  }
  return "unknown";
}

std::optional<Status> reason_to_stop(const StoppingRule& rule, const SolveReport& report) {
  if (std::isnan(report.judgement.residual)) return Status::not_finite;
  if (report.judgement.residual <= rule.tolerance && report.judgement.penetration <= rule.penetration)
    return Status::converged;
  if (report.sweeps >= rule.max_sweeps) return Status::out_of_sweeps;
  if (report.seconds > rule.max_seconds) return Status::out_of_time;
  return {};
}

namespace {

/// Whether problems of a kind have a vectorised form.
template <class Problem>
constexpr bool has_lanes = requires(SolverScratch<Problem>& s) {
  s.lanes.in_double;
};

/// Rolling resistance and driven walls are known to the methods that sweep alone.
template <class Problem>
constexpr bool only_swept = false;
template <class Cone, bool with_spin, bool with_driven>
constexpr bool only_swept<ContactProblem<Cone, GeneralDelassus<Cone, with_spin, with_driven>>> = true;

// Residual down to which sweeps in single precision are worth while.
constexpr double single_precision_reaches = 1e-4;

}  // namespace

template <class Problem>
SolveReport solve_nlgs_scalar(const Problem& problem, const StoppingRule& rule,
                              SolverScratch<Problem>& scratch, std::vector<double>& r) {
  return sweep_until_judged(problem, rule, scratch, r, Plain{});
}

template <class Problem>
SolveReport solve_nncg(const Problem& problem, const StoppingRule& rule, SolverScratch<Problem>& scratch,
                       std::vector<double>& r) {
  return sweep_until_judged(problem, rule, scratch, r, FletcherReeves<typename Problem::Delassus>{});
}

template <class Problem>
SolveReport solve_nlgs(const Problem& problem, const StoppingRule& rule, SolverScratch<Problem>& scratch,
                       std::vector<double>& r) {
  if constexpr (has_lanes<Problem>)
    return sweep_in_lanes<double>(problem, rule, scratch, scratch.lanes.in_double, r, false);
  else
    return solve_nlgs_scalar(problem, rule, scratch, r);
}

template <class Problem>
SolveReport solve_accelerated_double(const Problem& problem, const StoppingRule& rule,
                                     SolverScratch<Problem>& scratch, std::vector<double>& r) {
  if constexpr (has_lanes<Problem>)
    return sweep_in_lanes<double>(problem, rule, scratch, scratch.lanes.in_double, r, true);
  else
    return sweep_until_judged(problem, rule, scratch, r, Extrapolation<typename Problem::Delassus>{});
}

template <class Problem>
SolveReport solve_accelerated(const Problem& problem, const StoppingRule& rule,
                              SolverScratch<Problem>& scratch, std::vector<double>& r) {
  if constexpr (!has_lanes<Problem>) {
    return solve_accelerated_double(problem, rule, scratch, r);
  } else {
    StoppingRule coarse = rule;
    coarse.tolerance = std::max(rule.tolerance, single_precision_reaches);
    const SolveReport first =
        sweep_in_lanes<float>(problem, coarse, scratch, scratch.lanes.in_single, r, true);
    const bool done = first.status == Status::converged && rule.tolerance == coarse.tolerance;
    if (done || first.status == Status::not_finite || first.status == Status::out_of_time ||
        first.sweeps >= rule.max_sweeps)
      return first;
    StoppingRule fine = rule;
    fine.max_sweeps -= first.sweeps;
    fine.max_seconds -= first.seconds;
    SolveReport report = solve_accelerated_double(problem, fine, scratch, r);
    report.sweeps += first.sweeps;
    report.seconds += first.seconds;
    return report;
  }
}

std::vector<std::string> contact_solver_names() {
  return {"accelerated", "accelerated-double", "nlgs", "nncg", "cpg", "reference", "nlgs-scalar"};
}

template <class Problem>
ContactSolver<Problem> contact_solver(const std::string& name) {
  if (name == "accelerated") return &solve_accelerated<Problem>;
  if (name == "accelerated-double") return &solve_accelerated_double<Problem>;
  if (name == "nlgs") return &solve_nlgs<Problem>;
  if (name == "nncg") return &solve_nncg<Problem>;
  if constexpr (!only_swept<Problem>) {
    if (name == "cpg") return &solve_cpg<Problem>;
    if (name == "reference") return &solve_reference<Problem>;
  }
  if (name == "nlgs-scalar") return &solve_nlgs_scalar<Problem>;
  const auto names = contact_solver_names();
  if (std::find(names.begin(), names.end(), name) != names.end())
    throw InputError({InputProblem{
        "", 0, 0, "solver.name", "'" + name + "' knows neither rolling resistance nor walls moved by a force",
        "accelerated, nlgs, nncg"}});
  throw InputError({InputProblem{"", 0, 0, "solver", "unknown solver '" + name + "'",
                                 fmt::format("{}", fmt::join(contact_solver_names(), ", "))}});
}

#define DRUMLIN_INSTANTIATE(Problem)                                                                   \
  template SolveReport solve_nlgs(const Problem&, const StoppingRule&, SolverScratch<Problem>&,        \
                                  std::vector<double>&);                                               \
  template SolveReport solve_accelerated(const Problem&, const StoppingRule&, SolverScratch<Problem>&, \
                                         std::vector<double>&);                                        \
  template SolveReport solve_nncg(const Problem&, const StoppingRule&, SolverScratch<Problem>&,        \
                                  std::vector<double>&);                                               \
  template ContactSolver<Problem> contact_solver<Problem>(const std::string&);
DRUMLIN_INSTANTIATE(FrictionlessProblem)
DRUMLIN_INSTANTIATE(CoulombProblem)
DRUMLIN_INSTANTIATE(CoulombSpinProblem)
DRUMLIN_INSTANTIATE(BlockProblem)
DRUMLIN_INSTANTIATE(CoulombRollingProblem)
DRUMLIN_INSTANTIATE(DrivenFrictionlessProblem)
DRUMLIN_INSTANTIATE(DrivenCoulombProblem)
DRUMLIN_INSTANTIATE(DrivenCoulombSpinProblem)
DRUMLIN_INSTANTIATE(DrivenRollingProblem)
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin
