#include "apps/commands/calibrate/fitting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "continuum/rheology/ill_posed_ranges.hpp"
#include "coupling/exchange/errors.hpp"

namespace drumlin::apps {
namespace {

constexpr std::size_t points_of_a_table = 24;        // fewer hold no knots
constexpr std::size_t points_of_a_good_table = 100;  // fewer follow their noise: a formula says more
constexpr std::size_t kept_draws = 16;               // in the law's file: the continuum solves each

using Points = std::vector<std::vector<FrictionPoint>>;

Points friction_of_all(const Calibration& calibration, const std::vector<RunEvidence>& runs) {
  Points points;
  for (const RunEvidence& run : runs) points.push_back(friction_of(run, calibration));
  return points;
}

std::vector<double> inertial_numbers(const Points& runs) {
  std::vector<double> I;
  for (const auto& run : runs)
    for (const FrictionPoint& point : run) I.push_back(point.I);
  return I;
}

// Knots of all points, or nothing where they are too few.
std::optional<FrictionForm> table_of(const Points& runs, bool growing) {
  const std::vector<double> I = inertial_numbers(runs);
  if (I.size() < points_of_a_table) return std::nullopt;
  return FrictionForm{FormKind::table, table_knots(I), growing};
}

void fit_turn(Calibration& calibration, const CalibrateOptions& options) {
  Points points;
  for (const RunEvidence& run : calibration.runs)
    points.push_back(calibration.source == Source::maps ? turns(run.blocks) : run.ratios);
  const auto form = table_of(points, false);
  if (!form)
    throw InputError(fmt::format("k(I) needs at least {} points, there are {}", points_of_a_table,
                                 inertial_numbers(points).size()));
  calibration.turn = calibrated(points, *form, options.draws);
}

void fit_forms(Calibration& calibration, const CalibrateOptions& options) {
  const Points points = friction_of_all(calibration, calibration.runs);
  std::vector<FrictionForm> forms{{FormKind::log, {}}, {FormKind::log_linear, {}}};
  if (const auto knots = table_of(points, true)) forms.push_back(*knots);
  const bool table =
      forms.back().kind == FormKind::table && inertial_numbers(points).size() >= points_of_a_good_table;
  const FormKind asked = options.law != "auto" ? form_named(options.law)
                         : table               ? FormKind::table
                                               : FormKind::log;
  bool found = false;
  for (const FrictionForm& form : forms) {
    // One form more than the points allow is no fault unless it was asked for.
    if (form.kind != asked && inertial_numbers(points).size() <= form.size()) continue;
    if (form.kind == asked) {
      calibration.chosen = calibration.forms.size();
      found = true;
    }
    calibration.forms.push_back(calibrated(points, form, options.draws));
  }
  if (!found)
    throw InputError(
        fmt::format("a table of mu(I) needs at least {} points, there are {}: take --law log, or more runs",
                    points_of_a_table, inertial_numbers(points).size()));
}

void require_growth(const CalibratedLaw& law) {
  const double middle = std::sqrt(law.I_min * law.I_max);
  if (friction_slope(law.form, law.fit.law, middle) > 0 || law.form.kind == FormKind::table) return;
  throw InputError(
      fmt::format("mu(I) does not grow with I between {:.2g} and {:.2g} (mu = {:.4f}): such a law has no "
                  "steady flow; calibrate on longer or more accurate runs, or on another range of I",
                  law.I_min, law.I_max, law.fit.law[0]));
}

RheologyFit rheology_of(const Calibration& calibration, const CalibrateOptions& options) {
  const CalibratedLaw& law = calibration.law();
  RheologyFit fit;
  fit.mu = measured_friction(law.form, law.fit.law, law.draws, law.I_min, law.I_max);
  fit.rms_misfit = law.fit.rms_misfit;
  for (std::size_t d = 0; d < std::min(kept_draws, law.draws.size()); ++d)
    fit.draws.push_back(measured_friction(law.form, law.draws[d], {}, law.I_min, law.I_max));
  if (options.k) {
    const CalibratedLaw& turn = *calibration.turn;
    fit.k = calibration.source == Source::maps ? stress_ratio(turn.form, turn.fit.law) : NormalStressRatio{};
    if (calibration.source == Source::profiles)
      for (const double I : turn.form.knots) {
        fit.k->I.push_back(I);
        fit.k->k.push_back(friction(turn.form, turn.fit.law, I));
      }
  }
  const auto runs = static_cast<double>(calibration.runs.size());
  double nu_ci99 = 0;
  for (const RunEvidence& run : calibration.runs) {
    const Scalar* nu = run.run.scalars.find("nu_bulk");
    if (nu == nullptr || !std::isfinite(nu->value))
      throw InputError((run.run.folder / "measured" / "measured.json").string() +
                       ": nu_bulk: was not measured, and the law needs the volume fraction of the bulk");
    fit.nu += nu->value / runs;
    nu_ci99 = std::hypot(nu_ci99, nu->ci99.value_or(std::nan("")) / runs);
    fit.fitted_on.push_back(run.run.name);
  }
  if (std::isfinite(nu_ci99)) fit.nu_ci99 = nu_ci99;
  fit.reduced = calibration.runs.front().run.reduced;
  return fit;
}

std::vector<RunsOfSpeed> speeds_of(const Calibration& calibration) {
  std::map<long, RunsOfSpeed> groups;  // by hundredths of a turn per minute
  for (const RunEvidence& run : calibration.runs) {
    RunsOfSpeed& group = groups[std::lround(100 * run.rotation_rpm)];
    group.name = fmt::format("{:.4g} rpm", run.rotation_rpm);
    group.runs.push_back(friction_of(run, calibration));
  }
  std::vector<RunsOfSpeed> speeds;
  for (auto& entry : groups) speeds.push_back(std::move(entry.second));
  return speeds;
}

void judge(Calibration& calibration, const CalibrateOptions& options) {
  const CalibratedLaw& law = calibration.law();
  for (const RunEvidence& run : calibration.runs)
    calibration.scores.push_back(score_of(run.run.name, friction_of(run, calibration), law));
  for (const RunEvidence& run : calibration.held_out)
    calibration.predictions.push_back(score_of(run.run.name, friction_of(run, calibration), law));
  const auto speeds = speeds_of(calibration);
  if (speeds.size() > 1) calibration.one_law = one_law_of(speeds, law, options.draws);
  const std::optional<StressRatioLaw> k =
      calibration.rheology.k
          ? std::optional(StressRatioLaw(calibration.rheology.k->I, calibration.rheology.k->k))
          : std::nullopt;
  for (const InertialRange& range : ill_posed_ranges(stress_law(calibration.rheology), k ? &*k : nullptr))
    calibration.ill_posed.push_back({range.from, range.to});
}

}  // namespace

std::vector<FrictionPoint> friction_of(const RunEvidence& run, const Calibration& calibration) {
  if (calibration.source == Source::profiles) return run.layers;
  // Misalignment alone is looked at, not a part of the law.
  if (!calibration.with_k) return frictions(run.blocks);
  return frictions_with_k(run.blocks, calibration.turn->form, calibration.turn->fit.law);
}

Calibration calibration_of(const CalibrateOptions& options) {
  Calibration calibration;
  calibration.source = source_of(options);
  calibration.runs = evidence_of(options.runs, calibration.source, options);
  calibration.held_out = evidence_of(options.validate, calibration.source, options);
  std::vector<MeasuredRun> all;
  for (const auto* group : {&calibration.runs, &calibration.held_out})
    for (const RunEvidence& run : *group) all.push_back(run.run);
  require_same_units(all);

  if (options.k || options.misalignment || options.relaxation) fit_turn(calibration, options);
  calibration.with_k = options.k;
  fit_forms(calibration, options);
  require_growth(calibration.law());
  calibration.rheology = rheology_of(calibration, options);
  judge(calibration, options);
  if (options.relaxation)
    for (const RunEvidence& run : calibration.runs)
      calibration.relaxations.push_back(
          fabric_relaxation(*run.map, calibration.turn->form, calibration.turn->fit.law));
  return calibration;
}

}  // namespace drumlin::apps
