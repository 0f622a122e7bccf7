#pragma once
// One contact problem that stands alone, solved by name and judged by the project's residual.
#include <string>

#include "particles/contact/solution.hpp"
#include "particles/lab/block_delassus.hpp"
#include "particles/solver/stopping_rule.hpp"

namespace drumlin::particles {

/// Impulses and velocities of a problem, and the report of the solver.
struct SolvedContacts {
  SolveReport report;  ///< its residual is that of the problem as it was given
  Solution<BlockProblem> solution;
  bool of_discs = false;  ///< W is that of discs, through which it was solved
};

/// Solves from rest, through the discs where W is that of discs, as in a run. `solver`: one of
/// any_solver_names(), else InputError. Does not throw where the rule is missed: the report says so.
SolvedContacts solve_contacts(const BlockProblem& problem, const StoppingRule& rule,
                              const std::string& solver = "accelerated", int threads = 1);

}  // namespace drumlin::particles
