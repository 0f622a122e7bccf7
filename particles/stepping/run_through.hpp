#pragma once
// A simulation from one step to its end, and what of a step must not be built upon.
#include <functional>
#include <optional>
#include <string>

#include "coupling/core/basics/run_status.hpp"
#include "particles/stepping/simulation.hpp"

namespace drumlin::particles {

/// Whether the contacts of a step were solved to the tolerances of its scene.
bool is_converged(const StepReport& report);

/// Mean overlap of the loaded contacts of a step, d, above which discs count as crushed.
inline constexpr double crushing_overlap = 0.2;

/// Why the state after a step must not be built upon.
struct StepFault {
  RunStatus status;  ///< of a run that ends with it
  std::string why;   ///< a sentence with the numbers
};
/// The first fault of a step; none of one that may be built upon, as the scene's solver settings say.
std::optional<StepFault> fault_of(const StepReport& report, const SolverSettings& solver);

/// One step. Throws NotConvergedError ("step 12: ...") where its state must not be built upon.
StepReport checked_step(Simulation& simulation);

/// Steps until the scene ends or `stepped`, called after each step, answers false. Throws as checked_step().
void run_through(Simulation& simulation, const std::function<bool(const StepReport&)>& stepped);

}  // namespace drumlin::particles
