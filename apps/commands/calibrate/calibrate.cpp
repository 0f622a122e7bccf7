// drumlin calibrate: one law from the tensors or profiles of one or more runs.
#include "apps/commands/calibrate/calibrate.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "apps/commands/calibrate/calibration_json.hpp"
#include "apps/commands/calibrate/evidence.hpp"
#include "apps/json/json_file.hpp"
#include "apps/output/figures.hpp"
#include "apps/output/next_step.hpp"
#include "apps/output/output_folder.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/json_numbers.hpp"
#include "coupling/core/files/input_file.hpp"
#include "coupling/core/law/rheology_file.hpp"

namespace drumlin::apps {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

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
        f == calibration.chosen ? "*" : " ", name_of(law.form), law.fit.rms_misfit, law.fit.intrinsic_scatter,
        middle, coupling::half_width_at(law, middle));
    if (f == calibration.chosen && coupling::half_width_at(law, middle) > law.curve().at(middle).value)
      text +=
          "    warning: the interval is wider than mu itself: too few points for a law (longer or more runs, "
          "more layers)\n";
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

coupling::CalibrationOptions settings_of(const CalibrateOptions& options, coupling::EvidenceSource source) {
  coupling::CalibrationOptions settings{
      .source = source, .k = options.k, .turn = options.misalignment, .draws = options.draws};
  if (options.law != "auto") settings.form = options.law;
  return settings;
}

/// The laws of the bed, which Python fits to the maps of the runs, the first `fitted` of them: "tables" of
/// the law, keys of its "record", and what is "said".
Json laws_of_the_bed(const CalibrateOptions& options, const std::vector<MeasuredRun>& runs,
                     std::size_t fitted) {
  const Json requested{{"fitted", fitted},
                       {"draws", options.draws},
                       {"memory", options.memory},
                       {"nonlocal", options.nonlocal},
                       {"own_weight", options.amount ? Json(options.own_weight) : Json()},
                       {"I_min", number_or_null(options.I_min)},
                       {"I_max", number_or_null(options.I_max)}};
  std::vector<std::string> words{requested.dump()};
  for (const MeasuredRun& run : runs)
    words.insert(words.end(), {run.name, (run.folder / "measured" / "maps.h5").string()});
  // Modules may warn before it.
  const std::string said = output_of_script("../bed/command.py", words);
  const std::size_t line = said.starts_with("{") ? 0 : said.rfind("\n{");
  if (line == std::string::npos) throw IoError("bed/command.py: " + said);
  return Json::parse(said.substr(line));
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

/// A law stands in no folder with a manifest: its record says what was asked for.
void refuse_other_law(const fs::path& record, const std::string& requested) {
  if (!fs::is_regular_file(record)) return;
  const std::string before = read_json(record, "drumlin-calibration-1").value("asked", requested);
  if (before != requested)
    throw InputError(record.string() + ": its law is of other runs or options; --overwrite makes it anew");
}

}  // namespace

int calibrate(const CalibrateOptions& options) {
  const fs::path record = beside(options.output, ".json");
  if (options.existing == ExistingOutput::resume && fs::is_regular_file(options.output)) {
    refuse_other_law(record, requested_sum(described(options)));
    print_out(fmt::format("{}: done already\n", options.output.string()));
    return static_cast<int>(ExitCode::done);
  }
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
  coupling::Calibration calibration = coupling::calibration_of(
      std::move(fitted.evidence), std::move(held_out.evidence), settings_of(options, source));
  Json bed;
  if (options.memory || options.nonlocal) {
    bed = laws_of_the_bed(options, all, options.runs.size());
    calibration.rheology = parse_rheology(rheology_text(calibration.rheology) + bed.value("tables", ""),
                                          options.output.string());
  }
  const FolderLock lock = prepare_output_file(options.output, options.existing);
  Json content = calibration_json(calibration, all);
  if (!bed.is_null()) content.update(bed["record"]);
  content["asked"] = requested_sum(described(options));
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
  print_out(fmt::format("{}{}{}{}{}", forms_text(calibration), posedness_text(calibration),
                        score_text("fitted", calibration.scores),
                        score_text("predicted", calibration.predictions), one_law_text(calibration)));
  if (!bed.is_null()) print_out(bed.value("said", ""));
  constexpr int fewest = 199;  // one of them beyond each end of 99 %
  if (options.draws < fewest)
    print_out(fmt::format("  warning: the 99 % band lies beyond {} draws and is too narrow; {} hold it\n",
                          options.draws, fewest));
  for (const MeasuredRun& run : all)
    for (const std::string& reason : run.unsteady)
      print_out(fmt::format("  warning: {} is not steady: {}\n", run.name, reason));
  const bool of_a_drum = all.front().profiles.header.drum_radius.value_or(0) > 0;
  print_out(next_step("calibrate", of_a_drum ? Flowing::drum : Flowing::layers, Verdict::done,
                      options.output.string()));
  return static_cast<int>(ExitCode::done);
}

Command calibrate_command() {
  return command("calibrate", "Fits mu(I), and k(I) on request, to measured runs", calibrate);
}

}  // namespace drumlin::apps
