#pragma once
// What every contact solver takes and returns. The one place that knows their names is contact_solver()
// below.
#include <chrono>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "particles/contact/body_delassus.hpp"
#include "particles/contact/residual.hpp"
#include "particles/solver/conjugate_projected_gradient.hpp"
#include "particles/solver/lane_solver.hpp"

namespace drumlin {

enum class Status { converged, out_of_sweeps, out_of_time, not_finite };
std::string to_string(Status);

/// When a solver may stop. It stops when both tolerances hold, as the judge sees them.
struct StoppingRule {
  double tolerance = 1e-2;                                       ///< of Judgement::residual
  double penetration = std::numeric_limits<double>::infinity();  ///< of Judgement::penetration
  int max_sweeps = 1000;
  int check_every = 10;  ///< sweeps between two judgements; a judgement costs about one sweep
  double max_seconds =
      std::numeric_limits<double>::infinity();  ///< wall time; finite limits make a run irreproducible
};

struct [[nodiscard]] SolveReport {
  Status status = Status::out_of_sweeps;
  int sweeps = 0;
  Judgement judgement;  ///< of the impulses returned
  double seconds = 0;
};

/// Why a solver that was just judged must stop; nothing as long as it may go on.
std::optional<Status> reason_to_stop(const StoppingRule&, const SolveReport&);

/// Work space of the vectorised solvers; problems that they do not know have none.
template <class Delassus>
struct LaneScratch {};
template <class Cone, bool with_spin>
struct LaneScratch<BodyDelassus<Cone, with_spin>> {
  LaneProblem<double, Cone::dim, with_spin> in_double;
  LaneProblem<float, Cone::dim, with_spin> in_single;
  SweepPlan plan;  ///< of a problem that brings none
  std::vector<std::int32_t> order;
};

/// Work space of a solver, kept between calls so that a step does not allocate. It carries no information
/// from one call to the next.
template <class Problem>
struct SolverScratch {
  typename Problem::Delassus::State state, state_before, direction_state;
  std::vector<double> step, direction;
  JudgeScratch<typename Problem::Delassus> judge;
  LaneScratch<typename Problem::Delassus> lanes;
  ProjectedGradientScratch projected_gradient;
  ThreadTeam* team = nullptr;  ///< none: the calling thread alone; results do not depend on it
};

/// r: warm start in, solution out (dim * contacts entries).
template <class Problem>
using ContactSolver = SolveReport (*)(const Problem&, const StoppingRule&, SolverScratch<Problem>&,
                                      std::vector<double>& r);

/// The default: nonlinear Gauss-Seidel sweeps with Nesterov's extrapolation between them
/// (particles/solver/momentum.hpp). Problems of discs are swept in lanes, on vectors and threads: in single
/// precision as long as that helps, which is down to residuals of some 1e-4, and in double precision from
/// there. The judge is as strict as ever. Ends on a sweep, so that r lies in the cone.
template <class Problem>
SolveReport solve_accelerated(const Problem&, const StoppingRule&, SolverScratch<Problem>&,
                              std::vector<double>& r);
/// The same in double precision from the beginning.
template <class Problem>
SolveReport solve_accelerated_double(const Problem&, const StoppingRule&, SolverScratch<Problem>&,
                                     std::vector<double>& r);

/// Nonlinear Gauss-Seidel (Jean 1999; the paper, Sec. II): each contact exactly in turn. Problems of discs in
/// lanes, in double precision.
template <class Problem>
SolveReport solve_nlgs(const Problem&, const StoppingRule&, SolverScratch<Problem>&, std::vector<double>& r);

/// The same one contact after the other, in the order of the problem: what the others are checked and timed
/// against.
template <class Problem>
SolveReport solve_nlgs_scalar(const Problem&, const StoppingRule&, SolverScratch<Problem>&,
                              std::vector<double>& r);

/// Nonlinear nonsmooth conjugate gradients (Silcowitz, Niebe, Erleben 2010): Fletcher-Reeves over the steps
/// of Gauss-Seidel sweeps, restarted when they grow, one contact after the other.
template <class Problem>
SolveReport solve_nncg(const Problem&, const StoppingRule&, SolverScratch<Problem>&, std::vector<double>& r);

/// Conjugate projected gradient (Renouf and Alart 2005; the paper, Sec. II) with a diagonal preconditioner:
/// the quadratic problem of given friction bounds |r_t| <= b. Theirs moves the bounds b = mu r_n after every
/// step, which stalls near 1e-2 on drums; here they move when the problem of the old ones is solved as well
/// as its successor is known. A "sweep" is one product with W.
template <class Problem>
SolveReport solve_cpg(const Problem&, const StoppingRule&, SolverScratch<Problem>&, std::vector<double>& r);

/// As accurate as can be had: NNCG first, then proximal steps by a semismooth Newton method on the bodies (or
/// blocks), until a tolerance or a limit ends it. A Newton step, one sparse LU, counts as a "sweep". Never
/// returns worse than its NNCG start.
template <class Problem>
SolveReport solve_reference(const Problem&, const StoppingRule&, SolverScratch<Problem>&,
                            std::vector<double>& r);

/// Names of all solvers, for scenes and command lines.
std::vector<std::string> contact_solver_names();

/// Throws InputError for an unknown name.
template <class Problem>
ContactSolver<Problem> contact_solver(const std::string& name);

}  // namespace drumlin
