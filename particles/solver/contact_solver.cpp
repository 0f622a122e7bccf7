#include "particles/solver/contact_solver.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coupling/core/basics/errors.hpp"
#include "particles/solver/pivoting.hpp"
#include "particles/solver/strip_sweeps.hpp"
#include "particles/solver/two_methods.hpp"

namespace drumlin::particles {
namespace {

// Residual down to which sweeps in single precision pay.
constexpr double single_precision_reaches = 1e-4;

}  // namespace

template <class Problem>
SolveReport solve_nlgs(const Problem& problem, const StoppingRule& rule, SolverWorkspace<Problem>& work,
                       Solution<Problem>& solution) {
  const auto sweep = [&](const StoppingRule& own) {
    return sweep_in_strips<double>(problem, own, work, work.strips.in_double, solution, false);
  };
  if (!is_steep(problem)) return sweep(rule);
  const auto residual = [&] { return residual_of(problem, solution); };
  if constexpr (has_pivots<Problem>)
    return settle_in_turn(
        rule, solution.impulses, sweep,
        [&](const StoppingRule& own) { return settle_clusters(problem, own, solution); }, residual);
  else
    return from_two_starts(rule, solution.impulses, sweep, residual);
}

template <class Problem>
SolveReport solve_accelerated_double(const Problem& problem, const StoppingRule& rule,
                                     SolverWorkspace<Problem>& work, Solution<Problem>& solution) {
  const SolveReport first =
      sweep_in_strips<double>(problem, rule, work, work.strips.in_double, solution, true);
  if (first.status == Status::converged || !is_steep(problem)) return first;
  return go_on(
      rule, first, solution.impulses,
      [&](const StoppingRule& own) { return solve_nlgs(problem, own, work, solution); },
      [&] { return residual_of(problem, solution); });
}

template <class Problem>
SolveReport solve_accelerated(const Problem& problem, const StoppingRule& rule,
                              SolverWorkspace<Problem>& work, Solution<Problem>& solution) {
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

std::vector<std::string> contact_solver_names() { return {"accelerated", "nlgs"}; }

template <class Problem>
ContactSolver<Problem> contact_solver(const std::string& name) {
  if (name == "accelerated") return &solve_accelerated<Problem>;
  if (name == "nlgs") return &solve_nlgs<Problem>;
  throw InputError({InputProblem{"", 0, 0, "solver", "unknown solver '" + name + "'",
                                 fmt::format("{}", fmt::join(contact_solver_names(), ", "))}});
}

ContactSolvers contact_solvers(const std::string& name) {
  return std::apply(
      [&]<class... P>(ContactSolver<P>...) { return ContactSolvers{contact_solver<P>(name)...}; },
      ContactSolvers{});
}

#define DRUMLIN_INSTANTIATE(Problem, Law, spin)                                                          \
  template SolveReport solve_accelerated(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&, \
                                         Solution<Problem>&);                                            \
  template SolveReport solve_accelerated_double(const Problem&, const StoppingRule&,                     \
                                                SolverWorkspace<Problem>&, Solution<Problem>&);          \
  template SolveReport solve_nlgs(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&,        \
                                  Solution<Problem>&);                                                   \
  template ContactSolver<Problem> contact_solver<Problem>(const std::string&);
DRUMLIN_EACH_DISC_PROBLEM(DRUMLIN_INSTANTIATE)
#undef DRUMLIN_INSTANTIATE

}  // namespace drumlin::particles
