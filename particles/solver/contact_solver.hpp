#pragma once
// The contact solvers of scenes, behind one signature (solver_names.hpp).
#include <cstdint>
#include <vector>

#include "particles/contact/problems.hpp"
#include "particles/contact/solution.hpp"
#include "particles/solver/coarse_loads.hpp"
#include "particles/solver/solver_names.hpp"
#include "particles/solver/stopping_rule.hpp"
#include "particles/solver/strip_solver.hpp"

namespace drumlin::particles {

/// Work space of sweeps in strips; problems that are not of discs have none.
template <class Problem>
struct StripWorkspace {};
template <int dim, bool spin, class Law>
struct StripWorkspace<ContactProblem<DiscDelassus<dim, spin>, Law>> {
  StripProblem<double, Law, spin> in_double;
  StripProblem<float, Law, spin> in_single;
  SweepPlan plan;  ///< of a problem that brings none
  std::vector<std::int32_t> order;
};

/// Memory of a solver, kept between calls so that a step does not allocate. What is in it before a call is
/// never read, and nothing in it is a result.
template <class Problem>
struct SolverWorkspace {
  StripWorkspace<Problem> strips;
  CoarseLoads coarse;
  BodyPlaces places;  ///< of the bodies of the problem, for `coarse`; none: large problems do without
  WorkMemory* memory = nullptr;  ///< for what a solve needs until it ends; none: it is kept
  ThreadPool* pool = nullptr;    ///< none: the calling thread alone; results do not depend on it
  World* world = nullptr;        ///< none: this process alone; results do not depend on it
};

/// The default: nonlinear Gauss-Seidel sweeps with Nesterov's extrapolation between them
/// (particles/solver/momentum.hpp). Problems are swept in strips, on vectors and threads: in single
/// precision as long as that helps, which is down to residuals of some 1e-4, and in double precision from
/// there. The residual is always that in double precision. Where positions of the bodies are known, large
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

/// Nonlinear Gauss-Seidel (Jean 1999; the paper, Sec. II): each contact exactly in turn, in strips, in
/// double precision.
template <class Problem>
SolveReport solve_nlgs(const Problem&, const StoppingRule&, SolverWorkspace<Problem>&, Solution<Problem>&);

}  // namespace drumlin::particles
