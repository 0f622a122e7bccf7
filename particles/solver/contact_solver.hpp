#pragma once
// The contact solvers, behind one signature. The one place that knows their names is contact_solver() below.
#include <string>
#include <vector>

#include "particles/contact/body_delassus.hpp"
#include "particles/contact/general_delassus.hpp"
#include "particles/contact/solution.hpp"
#include "particles/solver/coarse_loads.hpp"
#include "particles/solver/conjugate_projected_gradient.hpp"
#include "particles/solver/stopping_rule.hpp"
#include "particles/solver/strip_solver.hpp"

namespace drumlin::particles {

/// Work space of the vectorised solvers; problems that they do not know have none.
template <class Delassus>
struct StripWorkspace {};
template <int dim, bool spin>
struct WorkspaceOfStrips {
  StripProblem<double, dim, spin> in_double;
  StripProblem<float, dim, spin> in_single;
  SweepPlan plan;  ///< of a problem that brings none
  std::vector<std::int32_t> order;
};
template <class Cone, bool with_spin>
struct StripWorkspace<BodyDelassus<Cone, with_spin>> : WorkspaceOfStrips<Cone::dim, with_spin> {};
template <class Cone, bool with_spin, bool with_driven>
struct StripWorkspace<GeneralDelassus<Cone, with_spin, with_driven>>
    : WorkspaceOfStrips<Cone::dim, with_spin> {};

/// Memory of a solver, kept between calls so that a step does not allocate. What is in it before a call is
/// never read, and nothing in it is a result.
template <class Problem>
struct SolverWorkspace {
  typename Problem::Delassus::State state, state_before, direction_state;
  std::vector<double> step, direction, best;
  StripWorkspace<typename Problem::Delassus> strips;
  ProjectedGradientWorkspace projected_gradient;
  CoarseLoads coarse;
  BodyPlaces places;  ///< of the bodies of the problem, for `coarse`; none: large problems do without
  WorkMemory* memory = nullptr;  ///< for what a solve needs until it ends; none: it is kept
  ThreadTeam* team = nullptr;    ///< none: the calling thread alone; results do not depend on it
  World* world = nullptr;        ///< none: this process alone; results do not depend on it
};

/// Solves a problem from the warm start in solution.impulses and leaves there the impulses found, in their
/// cones, with their velocities. The report is of these impulses; it does not throw when they miss the rule.
template <class Problem>
using ContactSolver = SolveReport (*)(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&,
                                      Solution<Problem>&);

/// The default: nonlinear Gauss-Seidel sweeps with Nesterov's extrapolation between them
/// (particles/solver/momentum.hpp). Problems of discs are swept in strips, on vectors and threads: in single
/// precision as long as that helps, which is down to residuals of some 1e-4, and in double precision from
/// there. The residual is always that in double precision. Where places of the bodies are known, large
/// problems are corrected on a coarse grid every few sweeps (particles/solver/coarse_loads.hpp).
/// Ends on a sweep, so that the impulses lie in their cones. Where they miss the rule they are the best that
/// the solver has checked at.
template <class Problem>
SolveReport solve_accelerated(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&,
                              Solution<Problem>&);
/// The same in double precision from the beginning.
template <class Problem>
SolveReport solve_accelerated_double(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&,
                                     Solution<Problem>&);

/// Nonlinear Gauss-Seidel (Jean 1999; the paper, Sec. II): each contact exactly in turn. Problems of discs in
/// strips, in double precision.
template <class Problem>
SolveReport solve_nlgs(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&, Solution<Problem>&);

/// The same one contact after the other, in the order of the problem: what the others are checked and timed
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
/// as its successor is known. A "sweep" is one product with W.
template <class Problem>
SolveReport solve_cpg(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&, Solution<Problem>&);

/// As accurate as can be had: accelerated sweeps, plain ones, then proximal steps by a semismooth Newton
/// method on the bodies (or blocks), until a tolerance or a limit ends it; both are asked before each Newton
/// step. A Newton step, one sparse LU, counts as a "sweep". Returns the best impulses seen.
template <class Problem>
SolveReport solve_reference(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&,
                            Solution<Problem>&);

/// Names of all solvers, for scenes and command lines.
std::vector<std::string> contact_solver_names();

/// Throws InputError for an unknown name.
template <class Problem>
ContactSolver<Problem> contact_solver(const std::string& name);

}  // namespace drumlin::particles
