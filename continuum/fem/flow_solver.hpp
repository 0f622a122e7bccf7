#pragma once
// Continuation and Newton's method from a problem to a flow.
#include <functional>
#include <string>
#include <vector>

#include "continuum/fem/flow_field.hpp"
#include "continuum/model/flow_problem.hpp"

namespace drumlin {

struct FlowSolverOptions {
  int levels = 2;                  ///< meshes, each with cells half as large; the last one carries the result
  double start_shear_rate = 0.3;   ///< eps of the first phase, 1/sqrt(d/g)
  double shear_rate_factor = 0.1;  ///< of eps from phase to phase; its square root where that fails
  double refined_shear_rate = 1e-3;  ///< eps at which a finer mesh starts from the coarser solution
  double phase_tolerance = 1e-2;     ///< on the residual, in all phases but the last of a mesh
  double tolerance = 1e-8;           ///< on the residual in the last phase of each mesh
  double linear_tolerance = 1e-6;    ///< on the true relative residual of every linear solve
  int max_iterations = 40;           ///< per phase
};

/// One nonlinear iteration.
struct IterationReport {
  int level = 0;
  std::string phase;          ///< "newtonian", "hydrostatic", "pressure", "shear rate", "refined"
  double shear_rate = 0;      ///< eps of the phase
  double pressure_share = 0;  ///< of the true pressure in the law
  int iteration = 0;          ///< within the phase
  double residual = 0;        ///< ||R||/||weight||, after the step
  double step_length = 0;
  double step_size = 0;        ///< ||du||/||u||
  double linear_residual = 0;  ///< true relative residual of the linear solves, the larger
  double theta = 0;            ///< rad
  double seconds = 0;          ///< since the start
};

/// Wall time of one kind of work, summed over all meshes and phases.
struct PhaseSeconds {
  std::string
      name;  ///< "assembly", "factorisation", "linear solves", "step length", "refinement", "evaluation"
  double seconds = 0;
  int times = 0;
};

struct FlowReport {
  bool converged = false;
  std::string failure;  ///< which phase, residual and last step; empty when converged
  double residual = 0;
  int iterations = 0;  ///< over all phases and meshes
  double seconds = 0;
  std::vector<PhaseSeconds> phases;
  std::vector<IterationReport> history;
};

struct FlowObserver {
  std::function<void(const IterationReport&)> iteration;            ///< empty: nobody watches
  std::function<void(int level, const FlowField&)> level_finished;  ///< also for the last level
  std::function<bool()> interrupted;                                ///< asked between iterations
};

struct FlowSolution {
  FlowReport report;
  FlowField field;  ///< the last iterate when not converged
};

/// Newtonian start, hydrostatic pressure in the law, homotopy to the true pressure, then eps downwards; on a
/// finer mesh the coarser solution, from eps = refined_shear_rate on. Newton's tangent is primal-dual, its
/// step length found on the slope R(u + alpha du).du. Throws NotConvergedError for a slope that admits no
/// steady flow (no_steady_state); a Newton iteration that does not converge, or a linear solve that misses
/// its tolerance, is in the report.
[[nodiscard]] FlowSolution solve_flow(const FlowProblem& problem, const FlowSolverOptions& options = {},
                                      const FlowObserver& observer = {});

}  // namespace drumlin
