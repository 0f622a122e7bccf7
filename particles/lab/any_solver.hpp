#pragma once
// All contact solvers by their names: those of scenes (particles/solver/contact_solver.hpp) and those for
// study, which `drumlin solve-contacts` and Python offer.
#include <string>
#include <vector>

#include "particles/lab/block_delassus.hpp"
#include "particles/solver/contact_solver.hpp"

namespace drumlin::particles {

std::vector<std::string> any_solver_names();

/// For problems of discs, or in blocks. Throws InputError for an unknown name, and for a method that does not
/// know the problem.
template <class Problem>
ContactSolver<Problem> any_solver(const std::string& name);

/// The same for each kind of problem that a step may have; nothing where the method does not know it.
ContactSolvers any_solvers(const std::string& name);

/// Nonlinear Gauss-Seidel one contact after the other: what the sweeps in strips are checked and timed
/// against.
template <class Problem>
SolveReport solve_nlgs_scalar(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&,
                              Solution<Problem>&);

/// Nonlinear nonsmooth conjugate gradients (Silcowitz, Niebe, Erleben 2010): Fletcher-Reeves over the steps
/// of Gauss-Seidel sweeps, restarted when they grow, one contact after the other.
template <class Problem>
SolveReport solve_nncg(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&, Solution<Problem>&);

/// Conjugate projected gradient (Renouf and Alart 2005; the paper, Sec. II) with a diagonal preconditioner:
/// the quadratic problem of given friction bounds |r_t| <= b. Theirs moves the bounds b = mu r_n after every
/// step, which stalls near 1e-2 on drums; here they move when the problem of the old ones is solved as well
/// as its successor is known. A "sweep" is one product with W. At most two unknowns per contact.
template <class Problem>
SolveReport solve_cpg(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&, Solution<Problem>&);

/// As accurate as can be had: accelerated sweeps, plain ones, then proximal steps by a semismooth Newton
/// method on the bodies (or blocks), until a tolerance or a limit ends it; both are asked before each Newton
/// step. A Newton step, one sparse LU, counts as a "sweep". Returns the best impulses found. At most two
/// unknowns per contact, and neither driven walls nor cells.
template <class Problem>
SolveReport solve_reference(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&,
                            Solution<Problem>&);

}  // namespace drumlin::particles
