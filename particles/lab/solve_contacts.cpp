#include "particles/lab/solve_contacts.hpp"

#include <utility>

#include "particles/lab/any_solver.hpp"
#include "particles/lab/disc_problem.hpp"
#include "particles/parallel/thread_pool.hpp"

namespace drumlin::particles {
namespace {

template <class Problem>
SolveReport solved(const Problem& problem, const StoppingRule& rule, const std::string& solver, int threads,
                   std::vector<double>& impulses) {
  ThreadPool pool(threads);
  SolverWorkspace<Problem> work;
  work.pool = &pool;
  Solution<Problem> solution;
  const SolveReport report = any_solver<Problem>(solver)(problem, rule, work, solution);
  impulses = std::move(solution.impulses);
  return report;
}

}  // namespace

SolvedContacts solve_contacts(const BlockProblem& problem, const StoppingRule& rule,
                              const std::string& solver, int threads) {
  SolvedContacts result;
  const auto discs = disc_problem(problem);
  result.of_discs = discs.has_value();
  result.report = discs ? solved(*discs, rule, solver, threads, result.solution.impulses)
                        : solved(problem, rule, solver, threads, result.solution.impulses);
  result.report.residual = residual_of(problem, result.solution);
  return result;
}

}  // namespace drumlin::particles
