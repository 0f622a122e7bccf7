#include "particles/lab/any_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "particles/lab/scalar_sweeps.hpp"
#include "particles/solver/momentum.hpp"
#include "particles/solver/two_methods.hpp"

namespace drumlin::particles {
namespace {

/// Sweeps until the rule ends it; returns the best where that is missed. after_sweep(impulses, squares of the
/// step) may move them on, but not after the last sweep.
template <class Problem, class AfterSweep>
SolveReport sweep_until_done(const Problem& problem, const StoppingRule& rule, Solution<Problem>& solution,
                             AfterSweep after_sweep) {
  StoppingTest test(rule);
  double best = std::numeric_limits<double>::infinity();
  std::vector<double> best_impulses;
  std::vector<double>& r = solution.impulses;
  SweptImpulses<Problem> swept(problem, r);
  for (int sweeps = 1;; ++sweeps) {
    const double squares = sweep(problem, swept);
    if (test.due(sweeps)) {
      const bool ended = test.ends(sweeps, residual_of(problem, solution), std::isfinite(squares));
      const bool converged = ended && test.report().status == Status::converged;
      if (test.report().residual.rms < best) best = test.report().residual.rms, best_impulses = r;
      if (ended && !converged && best < test.report().residual.rms) {
        r = best_impulses;
        test.replace(residual_of(problem, solution));
      }
      if (ended) return test.report();
    }
    after_sweep(swept, squares);
  }
}

/// Fletcher-Reeves: the step of a sweep plays the negative gradient. r and the state are linear in each
/// other, so the state is carried along instead of being computed from r again.
template <class Problem>
class FletcherReeves {
 public:
  explicit FletcherReeves(const Problem& problem, std::vector<double> r) {
    SweptImpulses<Problem> start(problem, r);
    state_before_.assign(start.numbers().begin(), start.numbers().end());
  }
  void operator()(SweptImpulses<Problem>& swept, double squares) {
    const auto state = swept.numbers();
    direction_.resize(swept.r.size()), state_direction_.resize(state.size());
    // In the first sweep, and where steps grow, it begins again along the step itself.
    const double ratio = squares_ > 0 ? squares / squares_ : 2, beta = ratio > 1 ? 0 : ratio;
    squares_ = squares;
    for (std::size_t k = 0; k < direction_.size(); ++k) {
      swept.r[k] += beta * direction_[k];
      direction_[k] = beta * direction_[k] + swept.step[k];
    }
    // The differences of inverse masses, which stand among the numbers, are zero.
    for (std::size_t k = 0; k < state.size(); ++k) {
      const double step = state[k] - state_before_[k];
      state[k] += beta * state_direction_[k];
      state_direction_[k] = beta * state_direction_[k] + step;
      state_before_[k] = state[k];
    }
  }

 private:
  double squares_ = 0;
  std::vector<double> direction_, state_direction_, state_before_;
};

/// Nesterov's extrapolation between sweeps. r and the state are linear in each other: both go on alike.
template <class Problem>
class Extrapolation {
 public:
  explicit Extrapolation(Momentum momentum) : momentum_(momentum) {}
  void operator()(SweptImpulses<Problem>& swept, double squares) {
    double beta = momentum_.next(squares);
    if (r_before_.empty()) {
      beta = 0;
      r_before_ = swept.r;
      state_before_.assign(swept.numbers().begin(), swept.numbers().end());
    }
    extrapolate(swept.r, r_before_, beta);
    extrapolate(swept.numbers(), state_before_, beta);
  }

 private:
  Momentum momentum_;
  std::vector<double> r_before_, state_before_;
};

// Of problems in blocks, which have no strips.
SolveReport solve_nlgs_of_blocks(const BlockProblem& problem, const StoppingRule& rule,
                                 SolverWorkspace<BlockProblem>& work, Solution<BlockProblem>& solution) {
  const auto sweep = [&](const StoppingRule& own) { return solve_nlgs_scalar(problem, own, work, solution); };
  if (!is_steep(problem)) return sweep(rule);
  return from_two_starts(rule, solution.impulses, sweep, [&] { return residual_of(problem, solution); });
}

SolveReport solve_accelerated_of_blocks(const BlockProblem& problem, const StoppingRule& rule,
                                        SolverWorkspace<BlockProblem>& work,
                                        Solution<BlockProblem>& solution) {
  if (is_steep(problem)) return solve_nlgs_of_blocks(problem, rule, work, solution);
  const Momentum momentum(rule.tolerance, static_cast<std::size_t>(problem.contacts()));
  return sweep_until_done(problem, rule, solution, Extrapolation<BlockProblem>(momentum));
}

bool is_known(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Nothing where the method does not know the problem.
template <class Problem>
ContactSolver<Problem> found(const std::string& name) {
  if (name == "nncg") return &solve_nncg<Problem>;
  if (name == "nlgs-scalar") return &solve_nlgs_scalar<Problem>;
  if constexpr (is_plain<typename Problem::Law>) {
    if (name == "cpg") return &solve_cpg<Problem>;
    if (name == "reference") return &solve_reference<Problem>;
  }
  if constexpr (of_discs<Problem>) {
    if (name == "accelerated-double") return &solve_accelerated_double<Problem>;
    if (is_known(contact_solver_names(), name)) return contact_solver<Problem>(name);
  } else {
    if (name == "nlgs") return &solve_nlgs_of_blocks;
    if (name == "accelerated" || name == "accelerated-double") return &solve_accelerated_of_blocks;
  }
  const auto all = any_solver_names();
  if (is_known(all, name)) return nullptr;
  throw InputError({InputProblem{"", 0, 0, "solver", "unknown solver '" + name + "'",
                                 fmt::format("{}", fmt::join(all, ", "))}});
}

}  // namespace

template <class Problem>
SolveReport solve_nlgs_scalar(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>&,
                              Solution<Problem>& solution) {
  return sweep_until_done(problem, rule, solution, [](const auto&, double) {});
}

template <class Problem>
SolveReport solve_nncg(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>&,
                       Solution<Problem>& solution) {
  return sweep_until_done(problem, rule, solution, FletcherReeves<Problem>(problem, solution.impulses));
}

std::vector<std::string> any_solver_names() {
  return {"accelerated", "accelerated-double", "nlgs", "nncg", "cpg", "reference", "nlgs-scalar"};
}

template <class Problem>
ContactSolver<Problem> any_solver(const std::string& name) {
  if (const auto solver = found<Problem>(name)) return solver;
  throw InputError({InputProblem{"", 0, 0, "solver", "'" + name + "' knows no law beyond Coulomb's",
                                 "accelerated, accelerated-double, nlgs, nncg, nlgs-scalar"}});
}

ContactSolvers any_solvers(const std::string& name) {
  return std::apply([&]<class... P>(ContactSolver<P>...) { return ContactSolvers{found<P>(name)...}; },
                    ContactSolvers{});
}

#define DRUMLIN_INSTANTIATE(Problem, Law, spin) \
  template ContactSolver<Problem> any_solver(const std::string&);
DRUMLIN_EACH_DISC_PROBLEM(DRUMLIN_INSTANTIATE)
DRUMLIN_INSTANTIATE(BlockProblem, Coulomb, )
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
