// drumlin calibrate: one law from the tensors or profiles of one or more runs.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "apps/commands/calibrate/calibration_json.hpp"
#include "apps/commands/calibrate/evidence.hpp"
#include "apps/commands/calibrate/nonlocal_json.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/commands.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/asked.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/files/input_file.hpp"
#include "coupling/core/law/rheology_file.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;

fs::path beside(const fs::path& file, const char* extension) {
  fs::path other = file;
  return other.replace_extension(extension);
}

std::string forms_text(const coupling::Calibration& calibration) {
  std::string text;
  for (std::size_t f = 0; f < calibration.forms.size(); ++f) {
    const coupling::CalibratedLaw& law = calibration.forms[f];
    const double middle = std::sqrt(law.I_min * law.I_max);
    text += fmt::format(
        "  {} {:<10}  rms misfit {:.4f}, scatter beyond the errors {:.4f}, band at I = {:.1e}: +- {:.4f}\n",
        f == calibration.chosen ? "*" : " ", name_of(law.form.kind), law.fit.rms_misfit,
        law.fit.intrinsic_scatter, middle, coupling::half_width_at(law, middle));
    if (f == calibration.chosen && coupling::half_width_at(law, middle) > law.curve().at(middle).value)
      text += "    warning: the interval is wider than mu itself: the runs are too short for a law\n";
  }
  return text;
}

std::string posedness_text(const coupling::Calibration& calibration) {
  const coupling::CalibratedLaw& law = calibration.law();
  std::string text;
  if (const std::size_t held = coupling::held_intervals(law.form, law.fit.law); held > 0)
    text = fmt::format(
        "  {} of {} intervals of the table are as flat as a well-posed law can be: the points require less\n",
        held, law.form.knots.size() - 1);
  if (calibration.ill_posed.empty()) return text + "  well-posed for every I from 1e-6 to 1 (simple shear)\n";
  text += "  ill-posed in simple shear for I";
  for (const InertialRange& range : calibration.ill_posed)
    text += fmt::format(" {:.1e} ... {:.1e}", range.from, range.to);
  return text + ": there a flow depends on its mesh\n";
}

std::string score_text(const char* what, const std::vector<coupling::LawScore>& scores) {
  std::string text;
  for (const coupling::LawScore& score : scores)
    text += fmt::format(
        "  {} {}: rms {:.4f}, mean {:+.4f}, {:.0f} % of {} points inside the 99 % interval{}\n", what,
        score.run, score.rms, score.bias, 100 * score.inside_prediction, score.points,
        score.outside_range == 0 ? "" : fmt::format(", {} beyond the range of I", score.outside_range));
  return text;
}

std::string one_law_text(const coupling::Calibration& calibration) {
  if (!calibration.one_law) return "";
  const coupling::OneLaw& one = *calibration.one_law;
  return fmt::format(
      "  one law for all speeds: {} (rms {:.4f}, with a law for each {:.4f}; at I = {:.1e} {} lies {:+.4f} "
      "off, {:.1f} times "
      "the 99 % width)\n",
      one.holds ? "yes" : "no", one.rms_common, one.rms_own, one.at_I, one.speed, one.difference,
      one.largest_ratio);
}

std::string interval_text(double value, const coupling::MemoryFit& fit, std::size_t j) {
  if (!fit.free[j]) return fmt::format("{:.2f} (held)", value);
  return fmt::format(
      "{:.2f} +- {:.2f} (over sectors{})", value, fit.ci99_sectors[j],
      std::isfinite(fit.ci99_runs[j]) ? fmt::format(", +- {:.2f} over runs", fit.ci99_runs[j]) : "");
}

std::string fit_text(const char* what, const coupling::MemoryFit& fit) {
  return fmt::format("  {}: c = {}, m = {}, chi = {}; rms of s/p {:.4f} over {} paths\n", what,
                     interval_text(fit.law.c, fit, coupling::memory_c),
                     interval_text(fit.law.m, fit, coupling::memory_m),
                     interval_text(fit.law.chi, fit, coupling::memory_chi), fit.rms, fit.paths);
}

std::string memory_scores_text(const char* what, const std::vector<coupling::MemoryScore>& scores) {
  std::string text;
  for (const coupling::MemoryScore& score : scores)
    text += fmt::format(
        "  {} {}: axes {:.1f} deg off in the bed, {:.1f} in the flow (without memory {:.1f}, {:.1f}); s/p "
        "{:.4f}, {:.4f}\n",
        what, score.run, score.bed.axes_deg, score.flow.axes_deg, score.bed.axes_deg_without_memory,
        score.flow.axes_deg_without_memory, score.bed.rms, score.flow.rms);
  return text;
}

std::string amount_scores_text(const char* what, const std::vector<coupling::AmountScore>& scores) {
  std::string text;
  for (const coupling::AmountScore& score : scores)
    text +=
        fmt::format("  {} {}: |s|/p {:.4f} off in the bed, {:.4f} in the flow (mu(I) alone {:.4f}, {:.4f})\n",
                    what, score.run, score.bed, score.flow, score.bed_alone, score.flow_alone);
  return text;
}

std::string amount_text(const coupling::AmountFit& fit) {
  const std::string own =
      fit.measured
          ? fmt::format("with the particles' own dilatancy, c_psi = {:g}, times {:.2f} +- {:.2f}",
                        fit.measured->c_psi, fit.measured->coefficient, fit.measured->coefficient_ci99)
          : "the particles show no dilatancy of their own to compare it with";
  const std::string creep =
      fit.law.creep ? fmt::format(", creep {:.4f} +- {:.4f} per ln(|D|/|W|) below {:g}", fit.law.creep->slope,
                                  fit.ci99_sectors[coupling::amount_creep], fit.law.creep->ratio)
                    : "";
  return fmt::format(
             "  the amount: swelling {:.4f} +- {:.4f} per ln I, c_nu = {:g}, c_psi = {:g}, lag {:.3f} +- "
             "{:.3f}{}; {}\n",
             fit.law.swelling, fit.ci99_sectors[coupling::amount_swelling], fit.law.c_nu, fit.law.c_psi,
             fit.law.lag, fit.ci99_sectors[coupling::amount_lag], creep, own) +
         amount_scores_text("fitted", fit.scores) + amount_scores_text("predicted", fit.predictions);
}

std::string memory_text(const coupling::Calibration& calibration) {
  if (!calibration.memory) return "";
  const coupling::MemoryCalibration& found = *calibration.memory;
  std::string text = fmt::format(
      "memory of the axes\n  |s|/p: a table of {} points, I from {:.1e} to {:.1e}, rms {:.4f}",
      found.amount.fit.points, found.amount.I_min, found.amount.I_max, found.amount.fit.rms_misfit);
  if (found.bed_line)
    text += fmt::format("; below I = {:g} {:.3f} + {:.4f} ln I, rms {:.4f}", coupling::bed_I,
                        found.bed_line->law[0], found.bed_line->law[1], found.bed_line->rms_misfit);
  text += "\n" + fit_text("the bed alone, chi at every I", found.bed_alone) +
          fit_text("bed and flow", found.free);
  if (!found.bounded.free[coupling::memory_m]) text += fit_text("m held", found.bounded);
  text += fmt::format(
      "  the law: c = {:.2f}, m = {:.2f}, chi = {:.2f} below I = {:g}, atan(1/c) above {:g}, c_rho = {:g}\n",
      found.law.c, found.law.m, found.law.chi, found.law.I_low, found.law.I_high, *found.law.c_rho);
  text += memory_scores_text("fitted", found.scores) + memory_scores_text("predicted", found.predictions);
  if (found.remembered) text += amount_text(*found.remembered);
  text += "  what the runs cannot tell\n";
  for (const std::string& sentence : found.untold) text += "  - " + sentence + "\n";
  return text;
}

coupling::CalibrationOptions settings_of(const CalibrateOptions& options, coupling::EvidenceSource source) {
  coupling::CalibrationOptions settings{.source = source,
                                        .k = options.k,
                                        .turn = options.misalignment,
                                        .memory = options.memory,
                                        .draws = options.draws,
                                        .nonlocal = options.nonlocal};
  if (options.amount) settings.amount_own_weight = options.own_weight;
  if (options.law != "auto") settings.form = coupling::form_named(options.law);
  return settings;
}

/// A run that counts twice makes intervals too small; one that is fitted predicts nothing.
void refuse_twice(const CalibrateOptions& options) {
  std::set<fs::path> seen;
  for (const auto* runs : {&options.runs, &options.validate})
    for (const fs::path& run : *runs)
      if (!seen.insert(fs::weakly_canonical(run)).second)
        throw InputError(run.string() + ": is named twice (allowed: each run once, to fit or to validate)");
}

/// Whether a file is the record of a law.
bool is_record(const fs::path& file) {
  try {
    (void)read_json(file, "drumlin-calibration-1");
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// Record and figure get the name of the law. What an interrupted call has left of them is written anew.
void refuse_files_of_others(const CalibrateOptions& options) {
  const fs::path record = beside(options.output, ".json"), figure = beside(options.output, ".png");
  if (record == options.output || figure == options.output)
    throw InputError(options.output.string() +
                     ": the record or the figure of the law has this name; name it .toml");
  if (options.existing != ExistingOutput::refuse) return;
  const auto refuse = [](const fs::path& file) {
    throw InputError(
        file.string() +
        ": exists already, and the law's own would take its place; give --overwrite, or name another law");
  };
  const bool has_record = fs::exists(fs::symlink_status(record));
  if (has_record && !is_record(record)) refuse(record);
  if (!has_record && fs::exists(fs::symlink_status(figure))) refuse(figure);
}

std::string asked_for(const CalibrateOptions& options) {
  nlohmann::ordered_json inputs = nlohmann::ordered_json::array(), held_out = inputs;
  for (const fs::path& run : options.runs) inputs.push_back(measured_run_sum(run));
  for (const fs::path& run : options.validate) held_out.push_back(measured_run_sum(run));
  return asked_sum({inputs, held_out, options.from, options.law, options.I_min.value_or(0),
                    options.I_max.value_or(0), options.draws, options.k, options.misalignment, options.memory,
                    options.nonlocal, options.amount, options.own_weight, options.accept_unsteady});
}

/// A law stands in no folder with a manifest: its record says what was asked for.
void refuse_other_law(const fs::path& record, const std::string& asked) {
  if (!fs::is_regular_file(record)) return;
  const std::string before = read_json(record, "drumlin-calibration-1").value("asked", asked);
  if (before != asked)
    throw InputError(record.string() + ": its law is of other runs or options; --overwrite makes it anew");
}

}  // namespace

int calibrate(const CalibrateOptions& options) {
  const fs::path record = beside(options.output, ".json");
  if (options.existing == ExistingOutput::resume && fs::is_regular_file(options.output)) {
    refuse_other_law(record, asked_for(options));
    print_out(fmt::format("{}: done already\n", options.output.string()));
    return static_cast<int>(ExitCode::done);
  }
  if (options.runs.empty()) throw InputError("calibrate needs at least one measured run");
  if (options.I_min && options.I_max && !(*options.I_min < *options.I_max))
    throw InputError(fmt::format("the range of I is {} to {} (allowed: 0 < I_min < I_max)", *options.I_min,
                                 *options.I_max));
  refuse_twice(options);
  refuse_files_of_others(options);
  const coupling::EvidenceSource source = source_of(options);
  MeasuredEvidence fitted = evidence_of(options.runs, source, options);
  require_bulk_fraction(fitted);
  MeasuredEvidence held_out = evidence_of(options.validate, source, options);
  std::vector<MeasuredRun> all = std::move(fitted.runs);
  all.insert(all.end(), held_out.runs.begin(), held_out.runs.end());
  require_same_units(all);
  const coupling::Calibration calibration = coupling::calibration_of(
      std::move(fitted.evidence), std::move(held_out.evidence), settings_of(options, source));
  const FolderLock lock = prepare_output_file(options.output, options.existing);
  nlohmann::ordered_json content = calibration_json(calibration, all);
  content["asked"] = asked_for(options);
  write_json(record, content);
  draw_figures("calibrate_figures.py", {record.string(), beside(options.output, ".png").string()});
  // Last: its presence says that all is there.
  write_rheology(options.output, calibration.rheology);

  const coupling::CalibratedLaw& law = calibration.law();
  print_out(fmt::format(
      "{}{}\n  {}\n  {} points of {} with I from {:.2g} to {:.2g}, where it is valid; nu {:.4f}\n",
      options.output.string(), calibration.rheology.reduced ? " (reduced)" : "",
      described(calibration.rheology.mu), law.fit.points,
      source == coupling::EvidenceSource::maps ? "the tensors of maps.h5" : "the layers of profiles.csv",
      law.I_min, law.I_max, calibration.rheology.nu));
  print_out(fmt::format("{}{}{}{}{}{}", forms_text(calibration), posedness_text(calibration),
                        score_text("fitted", calibration.scores),
                        score_text("predicted", calibration.predictions), one_law_text(calibration),
                        memory_text(calibration)));
  if (calibration.nonlocal) print_out(nonlocal_text(*calibration.nonlocal));
  constexpr int fewest = 199;  // one of them beyond each end of 99 %
  if (options.draws < fewest)
    print_out(fmt::format("  warning: the 99 % band lies beyond {} draws and is too narrow; {} hold it\n",
                          options.draws, fewest));
  for (const MeasuredRun& run : all)
    for (const std::string& reason : run.unsteady)
      print_out(fmt::format("  warning: {} is not steady: {}\n", run.name, reason));
  print_out(fmt::format("next: drumlin flow FLOW.toml --rheology {} -o FLOWRUN\n", options.output.string()));
  return static_cast<int>(ExitCode::done);
}

}  // namespace drumlin::apps
