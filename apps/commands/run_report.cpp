#include "apps/commands/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "apps/commands/region_table.hpp"
#include "apps/json/json_file.hpp"
#include "apps/process/progress.hpp"
#include "coupling/core/machine/own_costs.hpp"

namespace drumlin::apps {
namespace {

struct TimePart {
  const char* name;
  double seconds;
};

/// Where the wall time of a run went; the parts add up to it.
std::array<TimePart, 6> time_parts(const particles::RunTotals& t) {
  const double named =
      t.detection_seconds + t.setup_seconds + t.solver_seconds + t.projection_seconds + t.output_seconds;
  return {{{"detection", t.detection_seconds},
           {"setup", t.setup_seconds},
           {"solver", t.solver_seconds},
           {"projection", t.projection_seconds},
           {"output", t.output_seconds},
           {"rest", std::max(0.0, t.wall_seconds - named)}}};
}

/// The overlaps of the last stage, and where and when the deepest was.
nlohmann::ordered_json stage_overlaps(const RunProgress& run) {
  const auto& o = run.totals.stage_overlaps;
  const double mm = 1e3 * run.simulation.scales().length_m;
  nlohmann::ordered_json content = {
      {"stage", run.scene.stages[o.stage].name},
      {"overlap_mean", o.sum / static_cast<double>(std::max<std::int64_t>(1, o.steps))},
      {"overlap_max", o.max}};
  if (o.max > 0)
    content["deepest"] = {{"step", o.step},   {"time_s", o.time_s}, {"grain", o.grain},
                          {"other", o.other}, {"x_mm", mm * o.x},   {"z_mm", mm * o.z}};
  return content;
}

nlohmann::ordered_json accuracy(const RunProgress& run, double steps) {
  const particles::RunTotals& t = run.totals;
  return {{"solver", run.scene.solver.name},
          {"tolerance", run.scene.solver.tolerance},
          {"penetration_tolerance", run.scene.solver.penetration_tolerance},
          {"residual_mean", t.residual_sum / steps},
          {"residual_max", t.residual_max},
          {"penetration_mean", t.penetration_sum / steps},
          {"penetration_max", t.penetration_max},
          {"sinking_mean", t.sinking_sum / steps},
          {"sinking_max", t.sinking_max},
          {"overlap_mean", t.overlap_sum / steps},
          {"overlap_max", t.overlap_max},
          {"unresolved_impacts", t.unresolved_impacts},
          {"last_stage", stage_overlaps(run)}};
}

std::string stage_overlaps_text(const RunProgress& run) {
  const auto& o = run.totals.stage_overlaps;
  if (o.steps == 0) return "";
  std::string text = fmt::format("last stage, \"{}\": overlap mean {:.2g} d, largest {:.2g} d",
                                 run.scene.stages[o.stage].name, o.sum / static_cast<double>(o.steps), o.max);
  const double mm = 1e3 * run.simulation.scales().length_m;
  if (o.max > 0)
    text += fmt::format(" at t = {:.4g} s: {} and {} at x = {:.4g} mm, z = {:.4g} mm", o.time_s,
                        o.grain > 0 ? fmt::format("grain {}", o.grain) : "a grain that crossed it",
                        o.other > 0 ? fmt::format("grain {}", o.other) : "a wall", mm * o.x, mm * o.z);
  return text + "\n";
}

nlohmann::ordered_json cost(const RunProgress& run, double steps) {
  const particles::RunTotals& t = run.totals;
  nlohmann::ordered_json content = {
      {"contacts_mean", static_cast<double>(t.contacts) / steps},
      {"sweeps_mean", static_cast<double>(t.sweeps) / steps},
      {"ns_per_contact_and_sweep", t.contact_sweeps > 0 ? 1e9 * t.solver_seconds / t.contact_sweeps : 0}};
  for (const TimePart& part : time_parts(t)) content[std::string(part.name) + "_seconds"] = part.seconds;
  content["unknowns_per_contact"] = run.simulation.stepper().unknowns_per_contact();
  content["velocities_per_body"] = run.simulation.stepper().velocities_per_body();
  return content;
}

nlohmann::ordered_json energy(const particles::EnergyLedger& ledger) {
  nlohmann::ordered_json content = {{"kinetic", ledger.kinetic - ledger.kinetic_at_start},
                                    {"potential", ledger.potential - ledger.potential_at_start}};
  for (const auto& [name, work] : particles::exchanges(ledger)) content[name] = work;
  content["turnover"] = ledger.turnover;
  content["closing_error"] = particles::closing_error(ledger);
  return content;
}

// d, mean over steps and loaded contacts: ten times that of the shipped drums, and what a penetration
// tolerance of 1e-3 d stands for.
constexpr double much_overlap = 1e-3;
// d, at the worst contact of a step: twice what grains have that fall in when a drum begins to turn.
constexpr double deep_overlap = 0.25;
// d, the mean again: the packing holds more than its volume allows.
constexpr double crushing = 1e-2;

/// What ended each stage that is over, and when.
nlohmann::ordered_json stage_ends(const RunProgress& run) {
  nlohmann::ordered_json ends = nlohmann::ordered_json::array();
  const particles::SimulationState& state = run.simulation.state();
  std::int64_t step = 0;
  double time = 0;
  for (std::size_t s = 0; s < state.ends.size(); ++s) {
    const particles::StageEnd& end = state.ends[s];
    step += end.steps;
    time += static_cast<double>(end.steps) * run.simulation.plan().stages[s].time_step;
    ends.push_back({{"stage", run.scene.stages[s].name},
                    {"ended_by", name_of(end.by)},
                    {"step", step},
                    {"time_s", time * run.simulation.scales().time_s}});
  }
  return ends;
}

/// Grains that have left, stage by stage, and the first ones.
nlohmann::ordered_json left_report(const RunProgress& run) {
  const particles::LeftGrains& left = *run.simulation.state().left;
  nlohmann::ordered_json stages = nlohmann::ordered_json::array(), first = stages;
  std::int64_t all = 0;
  for (std::size_t s = 0; s < left.per_stage.size(); ++s) {
    all += left.per_stage[s];
    stages.push_back({{"stage", run.scene.stages[s].name}, {"grains", left.per_stage[s]}});
  }
  for (const particles::LeftGrain& grain : left.first)
    first.push_back({{"grain", grain.grain},
                     {"stage", run.scene.stages[grain.stage].name},
                     {"time_s", grain.time * run.simulation.scales().time_s}});
  return {{"grains", all}, {"stages", stages}, {"first", first}};
}

std::string left_warning(const particles::LeftGrains& left) {
  std::int64_t all = 0;
  for (const std::int64_t count : left.per_stage) all += count;
  std::string names;
  for (const particles::LeftGrain& grain : left.first)
    names += fmt::format("{}{}", names.empty() ? "" : ", ", grain.grain);
  return fmt::format("{} grains have left the scene (more than {:g} d outside), the first ones {}", all,
                     particles::left_distance, names);
}

}  // namespace

std::vector<std::string> run_warnings(const RunProgress& run) {
  const particles::RunTotals& t = run.totals;
  const double steps = std::max<double>(1, static_cast<double>(run.simulation.state().step));
  const auto& solver = run.scene.solver;
  std::vector<std::string> warnings;
  if (const auto missed = static_cast<double>(t.unconverged_steps); missed > unseen_missed_share * steps)
    warnings.push_back(fmt::format(
        "{} of {:.0f} steps ({:.0f} %) missed a tolerance: forces and positions of these steps do "
        "not hold. Raise solver.max_sweeps (now {}), shorten time_step_s, or allow larger errors by "
        "solver.tolerance ({:g}) and solver.penetration_tolerance ({:g} d)",
        t.unconverged_steps, steps, 100 * missed / steps, solver.max_sweeps, solver.tolerance,
        solver.penetration_tolerance));
  if (const double overlap = t.overlap_sum / steps; overlap > much_overlap)
    warnings.push_back(fmt::format(
        "loaded contacts overlap by {:.2g} d in the mean, and by {:.2g} d at worst: discs are not rigid "
        "here{}",
        overlap, t.overlap_max,
        overlap > crushing ? "; the load crushes them, or the time step is too long for it" : ""));
  else if (t.overlap_max > deep_overlap)
    warnings.push_back(fmt::format(
        "two discs overlapped by {:.2g} d in a step, more than {} d: they were crushed, or thrown into one "
        "another, as heavy discs do to light ones; what follows from it does not hold. Shorten time_step_s",
        t.overlap_max, deep_overlap));
  if (t.unresolved_impacts > 0)
    warnings.push_back(fmt::format(
        "{} times two discs met more often within a step than is followed: the rest of their speed was lost "
        "in the contact problem, also where restitution is 1. Shorten time_step_s",
        t.unresolved_impacts));
  if (const auto& left = run.simulation.state().left) warnings.push_back(left_warning(*left));
  if (const std::string text = start_warning(run.simulation.start_overlaps()); !text.empty())
    warnings.push_back(text);
  return warnings;
}

std::string start_warning(const particles::StartOverlaps& overlaps) {
  if (overlaps.pairs == 0) return {};
  return fmt::format(
      "{} pairs overlap at the start, by up to {:.2g} of the smaller diameter; the run pushes "
      "them apart",
      overlaps.pairs, overlaps.depth);
}

std::string progress_line(const std::string& who, const RunPosition& at, const particles::StepReport& last) {
  const auto done = static_cast<double>(at.step - at.steps_at_start);
  const double left = done > 0 ? at.spent_seconds / done * static_cast<double>(at.steps - at.step) : 0;
  return fmt::format(
      "{}{} {:5.1f} %  {}  t = {:.2f} s  contacts {}  sweeps {}  residual {:.1e}  overlap {:.1e} d  "
      "missed {}  left {}",
      at.scene.reduced ? "reduced " : "", who,
      100.0 * static_cast<double>(at.step) / static_cast<double>(at.steps),
      at.scene.stages[static_cast<std::size_t>(at.stage)].name, at.simulated_seconds, last.contacts,
      last.solve.sweeps, last.solve.residual.rms, last.overlap.mean, at.missed, duration_text(left));
}

ExitCode exit_code_of_missed(std::int64_t missed, std::int64_t steps) {
  return 2 * missed > steps ? ExitCode::not_converged : ExitCode::done;
}

RunRecord run_report(const RunProgress& run, RunStatus status) {
  const auto& state = run.simulation.state();
  const double steps = std::max<double>(1, static_cast<double>(state.step));
  RunRecord record;
  record.title.json = run.scene.title;
  record.reduced = run.scene.reduced;
  record.status = name_of(status);
  record.wall_seconds = run.totals.wall_seconds;
  record.cpu_seconds = run.totals.cpu_seconds;
  record.peak_memory_mb = own_peak_memory_mb();
  record.steps = state.step;
  record.steps_planned = run.simulation.plan().steps;
  record.unconverged_steps = run.totals.unconverged_steps;
  if (run.totals.unconverged_steps > 0) record.first_unconverged_step = run.totals.first_unconverged_step;
  record.revision = provenance().revision;
  record.seed = run.scene.seed;
  record.threads = run.threads;
  record.grains = state.bodies.count();
  record.simulated_seconds = state.time() * run.simulation.scales().time_s;
  record.snapshots = state.snapshots;
  record.accuracy.json = accuracy(run, steps);
  record.cost.json = cost(run, steps);
  record.warnings.json = run_warnings(run);
  if (particles::ends_stages_early(run.scene)) record.stages.json = stage_ends(run);
  if (state.traffic) record.regions.json = regions_of(run.scene, run.simulation);
  if (state.left) record.left.json = left_report(run);
  if (state.energy) record.energy.json = energy(*state.energy);
  record.scales.json = run.simulation.scales();
  record.provenance.json = provenance();
  return record;
}

std::string as_far_as_it_went(const particles::RunFolder& run) {
  return run.finished()
             ? ""
             : fmt::format("  the run is unfinished (status {}): as far as it went\n", name_of(run.status));
}

std::string run_summary(const RunProgress& run) {
  const particles::RunTotals& t = run.totals;
  const auto& state = run.simulation.state();
  const double steps = std::max<double>(1, static_cast<double>(state.step));
  std::string text = fmt::format(
      "{}{} steps, {} snapshots in {} ({:.0f} s of processor time); {} steps missed a tolerance (residual "
      "{:g}, penetration and sinking {:g} d)\n"
      "residual mean {:.2g}, largest {:.2g}; penetration mean {:.2g} d, largest {:.2g} d; sinking mean "
      "{:.2g} d, largest {:.2g} d; overlap mean {:.2g} d, largest {:.2g} d\n",
      run.scene.reduced ? "reduced: " : "", state.step, state.snapshots, duration_text(t.wall_seconds),
      t.cpu_seconds, t.unconverged_steps, run.scene.solver.tolerance, run.scene.solver.penetration_tolerance,
      t.residual_sum / steps, t.residual_max, t.penetration_sum / steps, t.penetration_max,
      t.sinking_sum / steps, t.sinking_max, t.overlap_sum / steps, t.overlap_max);
  text += stage_overlaps_text(run);
  text += fmt::format("{:<12}{:>12}{:>12}{:>9}\n", "time", "s", "ms/step", "share");
  for (const TimePart& part : time_parts(t))
    text +=
        fmt::format("{:<12}{:>12.2f}{:>12.3f}{:>7.1f} %\n", part.name, part.seconds,
                    1e3 * part.seconds / steps, t.wall_seconds > 0 ? 100 * part.seconds / t.wall_seconds : 0);
  text += regions_text(run.scene, run.simulation);
  for (const std::string& warning : run_warnings(run)) text += "warning: " + warning + "\n";
  return text;
}

}  // namespace drumlin::apps
