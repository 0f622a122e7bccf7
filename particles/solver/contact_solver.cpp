#include "particles/solver/contact_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "coupling/common/errors.hpp"
#include "particles/contact/problems.hpp"
#include "particles/parallel/work_memory.hpp"
#include "particles/solver/momentum.hpp"
#include "particles/solver/strip_sweeps.hpp"
#include "particles/solver/two_methods.hpp"

namespace drumlin::particles {
namespace {

/// Sweeps until the rule ends it; returns the best where that is missed. `after_sweep` may move r and the
/// state on, but not after the last sweep.
template <class Problem, class AfterSweep>
SolveReport sweep_until_done(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>& work,
                             Solution<Problem>& solution, AfterSweep after_sweep) {
  StoppingTest test(rule);
  double best = std::numeric_limits<double>::infinity();
  std::vector<double>& r = solution.impulses;
  r.resize(problem.q.size());
  work.step.resize(r.size());
  problem.W.load(work.state, r);
  for (int sweeps = 1;; ++sweeps) {
    after_sweep.before(work);
    const double step_squares = problem.W.sweep(problem.q, problem.mu, r, work.state, work.step);
    if (test.due(sweeps)) {
      const bool ended = test.ends(sweeps, residual_of(problem, solution), std::isfinite(step_squares));
      const bool converged = ended && test.report().status == Status::converged;
      if (test.report().residual.rms < best) best = test.report().residual.rms, work.best = r;
      if (ended && !converged && best < test.report().residual.rms) {
        r = work.best;
        test.replace(residual_of(problem, solution));
      }
      if (ended) return test.report();
    }
    after_sweep.after(work, r, step_squares);
  }
}

struct Plain {
  template <class Work>
  void before(Work&) {}
  template <class Work>
  void after(Work&, std::vector<double>&, double) {}
};

/// Fletcher-Reeves: the step of a sweep plays the negative gradient. r and the state are linear in each
/// other, so the state is carried along instead of being computed from r again.
template <class Delassus>
struct FletcherReeves {
  double previous_squares = 0;

  template <class Work>
  void before(Work& work) {
    work.state_before = work.state;
  }
  template <class Work>
  void after(Work& work, std::vector<double>& r, double step_squares) {
    auto now = Delassus::numbers(work.state);
    const auto then = Delassus::numbers(work.state_before);
    work.direction.resize(r.size());
    if (work.direction_state.size() != work.state.size()) work.direction_state.resize(work.state.size());
    auto direction_state = Delassus::numbers(work.direction_state);
    const double beta = previous_squares > 0 ? step_squares / previous_squares : 2;
    previous_squares = step_squares;
    if (beta > 1) {  // the first sweep, or growing steps: start again along the step itself
      for (std::size_t k = 0; k < r.size(); ++k) work.direction[k] = work.step[k];
      for (std::size_t k = 0; k < now.size(); ++k) direction_state[k] = now[k] - then[k];
      return;
    }
    for (std::size_t k = 0; k < r.size(); ++k) {
      r[k] += beta * work.direction[k];
      work.direction[k] = beta * work.direction[k] + work.step[k];
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
  bool begun = false;

  template <class Work>
  void before(Work&) {}
  template <class Work>
  void after(Work& work, std::vector<double>& r, double step_squares) {
    const double beta = momentum.next(step_squares);
    const auto go_on = [beta](double& now, double& then) {
      const double x = now;
      now += beta * (x - then);
      then = x;
    };
    auto& r_before = work.direction;
    if (beta == 0 || !std::exchange(begun, true)) {
      r_before = r;
      work.state_before = work.state;
      return;
    }
    for (std::size_t k = 0; k < r.size(); ++k) go_on(r[k], r_before[k]);
    auto now = Delassus::numbers(work.state), then = Delassus::numbers(work.state_before);
    for (std::size_t k = 0; k < now.size(); ++k) go_on(now[k], then[k]);
  }
};

/// Whether problems of a kind have a vectorised form.
template <class Problem>
constexpr bool has_strips = requires(SolverWorkspace<Problem>& s) {
  s.strips.in_double;
};

/// Rolling resistance and driven walls are known to the methods that sweep alone.
template <class Problem>
constexpr bool only_swept = false;
template <class Cone, bool with_spin, bool with_driven>
constexpr bool only_swept<ContactProblem<Cone, GeneralDelassus<Cone, with_spin, with_driven>>> = true;

// Residual down to which sweeps in single precision pay.
constexpr double single_precision_reaches = 1e-4;

}  // namespace

template <class Problem>
SolveReport solve_nlgs_scalar(const Problem& problem, const StoppingRule& rule,
                              SolverWorkspace<Problem>& work, Solution<Problem>& solution) {
  return sweep_until_done(problem, rule, work, solution, Plain{});
}

template <class Problem>
SolveReport solve_nncg(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>& work,
                       Solution<Problem>& solution) {
  return sweep_until_done(problem, rule, work, solution, FletcherReeves<typename Problem::Delassus>{});
}

template <class Problem>
SolveReport solve_nlgs(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>& work,
                       Solution<Problem>& solution) {
  const auto sweep = [&](const StoppingRule& own) {
    if constexpr (has_strips<Problem>)
      return sweep_in_strips<double>(problem, own, work, work.strips.in_double, solution, false);
    else
      return solve_nlgs_scalar(problem, own, work, solution);
  };
  if (!is_steep(problem)) return sweep(rule);
  return from_two_starts(rule, solution.impulses, sweep, [&] { return residual_of(problem, solution); });
}

template <class Problem>
SolveReport solve_accelerated_double(const Problem& problem, const StoppingRule& rule,
                                     SolverWorkspace<Problem>& work, Solution<Problem>& solution) {
  if constexpr (has_strips<Problem>) {
    const SolveReport first =
        sweep_in_strips<double>(problem, rule, work, work.strips.in_double, solution, true);
    if (first.status == Status::converged || !is_steep(problem)) return first;
    return go_on(
        rule, first, solution.impulses,
        [&](const StoppingRule& own) { return solve_nlgs(problem, own, work, solution); },
        [&] { return residual_of(problem, solution); });
  } else if (is_steep(problem))
    return solve_nlgs(problem, rule, work, solution);
  else
    return sweep_until_done(
        problem, rule, work, solution,
        Extrapolation<typename Problem::Delassus>{Momentum(rule.tolerance, problem.q.size() / Problem::dim)});
}

template <class Problem>
SolveReport solve_accelerated(const Problem& problem, const StoppingRule& rule,
                              SolverWorkspace<Problem>& work, Solution<Problem>& solution) {
  if constexpr (!has_strips<Problem>) {
    return solve_accelerated_double(problem, rule, work, solution);
  } else {
    StoppingRule coarse = rule;
    coarse.tolerance = std::max(rule.tolerance, single_precision_reaches);
    const SolveReport first =
        sweep_in_strips<float>(problem, coarse, work, work.strips.in_single, solution, true);
    if (first.status == Status::converged && rule.tolerance == coarse.tolerance) return first;
    const auto second = is_steep(problem) ? &solve_nlgs<Problem> : &solve_accelerated_double<Problem>;
    return go_on(
        rule, first, solution.impulses,
        [&](const StoppingRule& own) { return second(problem, own, work, solution); },
        [&] { return residual_of(problem, solution); });
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
        "accelerated, accelerated-double, nlgs, nncg, nlgs-scalar"}});
  throw InputError({InputProblem{"", 0, 0, "solver", "unknown solver '" + name + "'",
                                 fmt::format("{}", fmt::join(contact_solver_names(), ", "))}});
}

#define DRUMLIN_INSTANTIATE(Problem)                                                                     \
  template SolveReport solve_nlgs(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&,        \
                                  Solution<Problem>&);                                                   \
  template SolveReport solve_accelerated(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&, \
                                         Solution<Problem>&);                                            \
  template SolveReport solve_nncg(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&,        \
                                  Solution<Problem>&);                                                   \
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

}  // namespace drumlin::particles
