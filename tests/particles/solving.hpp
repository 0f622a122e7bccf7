#pragma once
// Contact problems solved by a solver's name.
#include <hwy/targets.h>

#include <string>

#include "particles/lab/any_solver.hpp"

namespace drumlin::test {
using namespace particles;

template <class Problem>
struct Solved : Solution<Problem> {
  SolveReport report;
};

template <class Problem>
Solved<Problem> solved_by(const std::string& solver, const Problem& problem, double tolerance, int max_sweeps,
                          ThreadPool* pool = nullptr, int check_every = StoppingRule{}.check_every) {
  StoppingRule rule;
  rule.tolerance = tolerance, rule.max_sweeps = max_sweeps, rule.check_every = check_every;
  SolverWorkspace<Problem> work;
  work.pool = pool;
  Solved<Problem> solution;
  solution.report = any_solver<Problem>(solver)(problem, rule, work, solution);
  return solution;
}

template <class Problem>
ContactResidual residual_at(const Problem& problem, const std::vector<double>& r) {
  return residual_of(problem, std::span<const double>(r));
}

/// Calls work(name) with each instruction set of this processor chosen, then chooses the best again.
template <class Work>
void on_each_instruction_set(Work work) {
  const auto choose = [](std::int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().DeInit();
  };
  for (const auto target : hwy::SupportedAndGeneratedTargets()) choose(target), work(hwy::TargetName(target));
  choose(0);
}

}  // namespace drumlin::test
