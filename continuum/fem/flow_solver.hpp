#pragma once
// Solves a flow problem by continuation and Newton's method; steps in time.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "continuum/fem/flow_field.hpp"
#include "continuum/model/flow_problem.hpp"

namespace drumlin::continuum {

struct FlowSolverOptions {
  int levels = 2;          ///< meshes, each with cells half as large; the last one carries the result
  int further_levels = 3;  ///< meshes beyond these that a kept flow may lie on, or be refined to
  /// Share of the cells that the step to a finer mesh halves, those with the largest jumps of the velocity
  /// gradient; 1: all.
  double refined_share = 1;
  double start_shear_rate = 0.3;    ///< eps of the first phase of a cold start, 1/sqrt(d/g)
  double shear_rate_factor = 0.03;  ///< of eps from phase to phase; its square root where that fails
  /// A finer mesh starts from the coarser solution, and a flow from its neighbour, at the last eps; where
  /// that fails, at this one.
  double careful_shear_rate = 1e-3;
  double phase_tolerance = 0.3;    ///< on the residual, in all phases but the last of a mesh
  double coarse_tolerance = 1e-4;  ///< on the residual in the last phase of all meshes but the last one
  double coarse_surface_tolerance = 0.01;  ///< d, of a surface that moves, on all meshes but the last one
  double tolerance = 1e-8;                 ///< on the residual in the last phase of the last mesh
  double linear_tolerance = 1e-6;          ///< on the true relative residual of every linear solve
  int max_iterations = 40;                 ///< per phase
  int max_picard_updates = 40;             ///< of the fields that the law takes from the flow
  /// On what a whole Picard update moves, velocity (mean square) and slope, relative. Where the material
  /// hardly shears the axes of its strain rate are noise: the drum at 6 rpm on cells of 2 d came to rest at
  /// 6e-4.
  double picard_tolerance = 1e-3;
  double coarse_picard_tolerance = 3e-3;  ///< of memory below a moving surface, on coarser meshes
  double loose_picard_tolerance = 3e-2;   ///< while a surface still moves
  double loose_memory_tolerance = 1e-6;   ///< on the residual, likewise
  double loose_tolerance = 1e-4;  ///< on the residual of a flow without memory, before its surface moves
  /// Share of picard_tolerance to which memory is settled where no step of the surface lessens what presses.
  double fine_picard_share = 0.2;
};

/// One nonlinear iteration.
struct IterationReport {
  int level = 0;
  std::string phase;  ///< "newtonian", "law", "shear rate", "refined", "neighbour", "k", "nonlocal", "memory"
  double shear_rate = 0;  ///< eps of the phase
  int iteration = 0;      ///< within the phase
  double residual = 0;    ///< ||R||/||weight|| after the step and what follows locally
  double step_length = 0;
  double step_size = 0;        ///< ||du||/||u||
  double linear_residual = 0;  ///< true relative residual of the linear solves, the larger
  double theta = 0;            ///< rad
  double seconds = 0;          ///< since the start
  bool rejected = false;       ///< of a phase that failed: the solve went back to the flow before it
};

/// The slope after the iteration (rad), where its state is one: absent of a phase that failed, and of a
/// surface that would hang over.
std::optional<double> slope_of(const IterationReport& line);

/// One step of a surface that moves.
struct SurfaceStepReport {
  int level = 0;
  double share = 0;   ///< of the step that Newton's method on the shape asked for; 0: the start on a mesh
  double height = 0;  ///< d, the largest of the surface, of either sign
  double resolved =
      0;  ///< d, rms of what presses on it as heights, sigma_nn/(nu cos theta): what the shape resolves
  double rms = 0;      ///< d, of all of it, more than 2 d from the ends
  double largest = 0;  ///< d, likewise
  int iterations = 0;  ///< of Newton's method for the flow
};

/// Wall time of one kind of work, summed over all meshes and phases.
struct PhaseSeconds {
  std::string name;  ///< "assembly", "factorisation", "linear solves", "step length", "local steps",
                     ///< "refinement", "evaluation"
  double seconds = 0;
  int times = 0;
};

struct FlowReport {
  bool converged = false;
  bool interrupted = false;  ///< by the observer: what ended it
  std::string failure;       ///< which phase, residual and last step; empty when converged
  std::string start;         ///< "cold", "neighbour", or why the neighbour did not serve
  double residual = 0;
  int iterations = 0;  ///< over all phases and meshes
  int meshes = 0;      ///< from the coarsest one on, also those that a neighbour made superfluous
  /// Picard updates of the fields that the law takes from the flow, on the last mesh; 0: it takes none.
  int picard_updates = 0;
  double picard_change = 0;  ///< what the last of them moved, relative, as if it had been taken whole
  double seconds = 0;
  std::vector<PhaseSeconds> phases;
  std::vector<IterationReport> history;
  std::vector<SurfaceStepReport> surface_steps;  ///< empty where the surface stays
};

struct FlowObserver {
  std::function<void(const IterationReport&)> iteration;  ///< empty: not observed
  std::function<void(const IterationReport&)> rejected;   ///< the last iteration of a phase that failed
  std::function<void(int level, const FlowField&)> level_finished;  ///< also for the last level
  std::function<void(const SurfaceStepReport&)> surface_step;       ///< of a surface that moves
  std::function<bool()> interrupted;                                ///< asked between iterations
  /// Where the law takes fields from the flow (k, nonlocal fluidity), and remembers nothing: the flow on the
  /// last mesh without them.
  std::function<void(const FlowField&)> solved_plain;
};

struct FlowSolution {
  FlowReport report;
  FlowField field;  ///< the last iterate when not converged
};

/// Newtonian start, the law at a large eps, then eps downwards; on a finer mesh the coarser solution. With k
/// or nonlocal fluidity the flow without them comes first on each mesh; then Picard updates alternate between
/// the fields that the law takes from the flow and the flow with them, until nothing changes. With memory of
/// the axes that is so on the first mesh alone; on finer ones and from a neighbour the memory follows from
/// the flow at hand. Newton's tangent is primal-dual, its step length found on the slope R(u + alpha du).du.
/// Throws NotConvergedError for a slope that admits no steady flow (no_steady_state); a Newton iteration that
/// does not converge, or a linear solve that misses its tolerance, is in the report.
[[nodiscard]] FlowSolution solve_flow(const FlowProblem& problem, const FlowSolverOptions& options = {},
                                      const FlowObserver& observer = {});

/// The same from the state of a flow at another speed or with another law, on that mesh of the problem which
/// fits the state and those after it; the meshes before are skipped. Where that fails it starts over cold,
/// and the report says so. Throws InputError when no mesh fits.
[[nodiscard]] FlowSolution solve_flow_from(const FlowState& neighbour, const FlowProblem& problem,
                                           const FlowSolverOptions& options = {},
                                           const FlowObserver& observer = {});

/// The flow of `problem` on cells half as large as those of `coarser`, its flow, and from it: the report is
/// that of both. No cold start follows where that fails; `coarser` stays as it is. Throws InputError when
/// `coarser` lies on none of the meshes (refined_share).
[[nodiscard]] FlowSolution solve_flow_finer(const FlowSolution& coarser, const FlowProblem& problem,
                                            const FlowSolverOptions& options = {},
                                            const FlowObserver& observer = {});

/// The flow of `problem` on the mesh of `start` and from it, for settings that differ a little: law,
/// regularisation, velocities of the sides. `start` must not be used to solve meanwhile, for it shares the
/// mesh.
[[nodiscard]] FlowSolution solve_flow_again(const FlowField& start, const FlowProblem& problem,
                                            const FlowSolverOptions& options = {},
                                            const FlowObserver& observer = {});

/// Steps in time by TR-BDF2, each of two systems.
struct FlowMarch {
  double time_step = 0;  ///< sqrt(d/g)
  int steps = 0;
  int first = 0;     ///< steps that were done before: time goes on from there
  int halvings = 6;  ///< of a step whose Newton iteration fails
  /// What holds on the sides at a time; empty: that of the problem.
  std::function<std::map<Side, BoundaryCondition>(double time)> boundary = {};
  std::function<void(double time, const FlowField&)> stepped = {};  ///< after each step; empty: not observed
};

/// The flow of `problem` from the state `start`, with inertia, in time: nu (du/dt + u.grad u) = -grad p + div
/// tau + f. The sides' velocities may differ from those of `start`, domain and mesh are its own; `start` must
/// not be used to solve meanwhile, for it shares the mesh. The slope is at every time that at which the
/// surface has no moment. Second order in the time step (the first half step by the implicit Euler method),
/// and it damps: a steady flow is kept to the tolerance.
/// Nothing but the state goes from one call to the next: a march in two calls, the second from a kept state
/// (flow_of_state), gives the same bits on one rank as in two calls at a stretch.
[[nodiscard]] FlowSolution march_flow(const FlowField& start, const FlowProblem& problem,
                                      const FlowMarch& march, const FlowSolverOptions& options = {},
                                      const FlowObserver& observer = {});

/// A kept flow as it is, on that mesh of `problem` which it fits, whatever the sides of the problem do.
/// Throws InputError when no mesh fits.
FlowField flow_of_state(const FlowState& kept, const FlowProblem& problem,
                        const FlowSolverOptions& options = {});

/// Zero state on the finest mesh; initial condition of a march in time.
FlowField flow_at_rest(const FlowProblem& problem, const FlowSolverOptions& options = {});

}  // namespace drumlin::continuum
