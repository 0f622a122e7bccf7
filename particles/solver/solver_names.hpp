#pragma once
// Names of the contact solvers that a scene may ask for, and the signature that all solvers have.
#include <string>
#include <tuple>
#include <vector>

#include "particles/contact/problem_kinds.hpp"

namespace drumlin::particles {

struct SolveReport;
struct StoppingRule;
template <class Problem>
struct SolverWorkspace;
template <class Problem>
struct Solution;

/// Solves a problem from the warm start in solution.impulses and leaves there the impulses found, in their
/// cones, with their velocities. The report is of these impulses; it does not throw when they miss the rule.
template <class Problem>
using ContactSolver = SolveReport (*)(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&,
                                      Solution<Problem>&);
/// A solver for each kind of problem.
using ContactSolvers = OfEachKind<std::tuple, ContactSolver>;

/// "accelerated", the default, and "nlgs". Those for study: particles/lab/any_solver.hpp.
std::vector<std::string> contact_solver_names();

/// One of contact_solver_names(), else throws InputError.
template <class Problem>
ContactSolver<Problem> contact_solver(const std::string& name);
ContactSolvers contact_solvers(const std::string& name);

}  // namespace drumlin::particles
