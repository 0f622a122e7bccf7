#include "particles/stepping/run_through.hpp"

#include <fmt/format.h>

#include "coupling/core/basics/errors.hpp"

namespace drumlin::particles {
namespace {

std::string described(const LostGrain& lost) {
  return fmt::format("grain {} {}; it is at x = {:.6g} d, z = {:.6g} d", lost.grain, to_string(lost.how),
                     lost.x, lost.z);
}

std::string missed_tolerance(const SolveReport& solve, const SolverSettings& solver) {
  const ContactResidual& residual = solve.residual;
  return fmt::format(
      "contact solver {} ({}) after {} sweeps: residual {:.3g} (tolerance {:g}), penetration {:.3g} d "
      "and sinking {:.3g} d (tolerance {:g})",
      solver.name, name_of(solve.status), solve.sweeps, residual.rms, solver.tolerance, residual.penetration,
      residual.sinking, solver.penetration_tolerance);
}

std::string crushed(double overlap) {
  return fmt::format(
      "loaded contacts overlap by {:.2g} d in the mean, more than {:g} d: discs are crushed, forces and "
      "places mean nothing. Shorten time_step_s or lower the load",
      overlap, crushing_overlap);
}

}  // namespace

bool is_converged(const StepReport& report) {
  return report.solve.status == Status::converged || report.contacts == 0;
}

std::optional<StepFault> fault_of(const StepReport& report, const SolverSettings& solver) {
  if (report.lost) return StepFault{RunStatus::grain_lost, described(*report.lost)};
  const bool fatal = solver.stop_when_unconverged || report.solve.status == Status::not_finite;
  if (!is_converged(report) && fatal)
    return StepFault{RunStatus::not_converged, missed_tolerance(report.solve, solver)};
  if (report.overlap.mean > crushing_overlap)
    return StepFault{RunStatus::crushed, crushed(report.overlap.mean)};
  return std::nullopt;
}

StepReport checked_step(Simulation& simulation) {
  const StepReport report = simulation.step();
  if (const auto fault = fault_of(report, simulation.scene().solver))
    throw NotConvergedError(fmt::format("step {}: {}", simulation.state().step, fault->why));
  return report;
}

void run_through(Simulation& simulation, const std::function<bool(const StepReport&)>& stepped) {
  while (!simulation.finished())
    if (!stepped(checked_step(simulation))) return;
}

}  // namespace drumlin::particles
