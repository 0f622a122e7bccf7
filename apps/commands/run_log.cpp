#include "apps/commands/run_log.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "coupling/core/documents/csv.hpp"

namespace drumlin::apps {

std::string log_line(const particles::StepReport& report, std::int64_t step, double time_s,
                     const std::string& stage, double kinetic_energy, bool converged) {
  const auto& residual = report.solve.residual;
  return fmt::format("{},{:.9g},{},{},{},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.4g},{:.9g},{}\n", step, time_s,
                     csv_text(stage), report.contacts, report.solve.sweeps, residual.rms, residual.max,
                     residual.penetration, residual.sinking, report.overlap.mean, report.overlap.max,
                     kinetic_energy, converged ? 1 : 0);
}

namespace {

void add_overlap(const particles::Overlap& overlap, const particles::Simulation& simulation,
                 particles::RunTotals::StageOverlaps& stage) {
  const auto& state = simulation.state();
  if (stage.steps == 0 || stage.stage != state.stage) stage = {.stage = state.stage};
  ++stage.steps;
  stage.sum += overlap.mean;
  if (!(overlap.max > stage.max)) return;
  stage.max = overlap.max;
  stage.step = state.step, stage.time_s = state.time() * simulation.scales().time_s;
  stage.grain = overlap.grain + 1, stage.other = std::max<std::int64_t>(0, overlap.other + 1);
  stage.x = overlap.x, stage.z = overlap.z;
}

}  // namespace

void add_up(const particles::StepReport& report, const particles::Simulation& simulation, bool converged,
            particles::RunTotals& totals) {
  const particles::ContactResidual& residual = report.solve.residual;
  totals.unconverged_steps += !converged;
  if (!converged && totals.unconverged_steps == 1) totals.first_unconverged_step = simulation.state().step;
  totals.unresolved_impacts += report.impacts_unresolved;
  totals.sweeps += report.solve.sweeps;
  totals.contacts += report.contacts;
  totals.contact_sweeps += static_cast<double>(report.contacts) * report.solve.sweeps;
  totals.residual_sum += residual.rms;
  totals.residual_max = std::max(totals.residual_max, residual.rms);
  totals.penetration_sum += residual.penetration;
  totals.penetration_max = std::max(totals.penetration_max, residual.penetration);
  totals.sinking_sum += residual.sinking;
  totals.sinking_max = std::max(totals.sinking_max, residual.sinking);
  totals.overlap_sum += report.overlap.mean;
  totals.overlap_max = std::max(totals.overlap_max, report.overlap.max);
  add_overlap(report.overlap, simulation, totals.stage_overlaps);
  totals.detection_seconds += report.detection_seconds;
  totals.setup_seconds += report.setup_seconds;
  totals.solver_seconds += report.solve.seconds;
  totals.projection_seconds += report.projection_seconds;
}

}  // namespace drumlin::apps
