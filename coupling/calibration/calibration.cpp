#include "coupling/calibration/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/law/rheology_file.hpp"

namespace drumlin::coupling {
namespace {

constexpr std::size_t points_of_a_table = 24;        // fewer hold no knots
constexpr std::size_t points_of_a_good_table = 100;  // fewer follow their noise: a formula says more
constexpr std::size_t saved_draws = 16;              // in the law's file: the continuum solves each

using PointsOfRuns = std::vector<std::vector<FrictionPoint>>;

std::vector<double> inertial_numbers(const PointsOfRuns& runs) {
  std::vector<double> I;
  for (const auto& run : runs)
    for (const FrictionPoint& point : run) I.push_back(point.I);
  return I;
}

// A table with the knots of all points, or nothing where they are too few.
std::optional<FrictionForm> table_of(const PointsOfRuns& runs, FormKind kind) {
  const std::vector<double> I = inertial_numbers(runs);
  if (I.size() < points_of_a_table) return std::nullopt;
  return FrictionForm{.kind = kind, .knots = table_knots(I)};
}

CalibratedLaw fitted_turn(const Calibration& calibration) {
  const bool maps = calibration.options.source == EvidenceSource::maps;
  PointsOfRuns points;
  for (const RunEvidence& run : calibration.runs) points.push_back(maps ? turns(run.blocks) : run.ratios);
  const auto form = table_of(points, maps ? FormKind::turn : FormKind::stress_ratio);
  if (!form)
    throw InputError(fmt::format("k(I) needs at least {} points, there are {}", points_of_a_table,
                                 inertial_numbers(points).size()));
  return calibrated(points, *form, calibration.options.draws);
}

void fit_forms(Calibration& calibration) {
  PointsOfRuns points;
  for (const RunEvidence& run : calibration.runs) points.push_back(friction_of(run, calibration));
  const std::size_t count = inertial_numbers(points).size();
  std::vector<FrictionForm> forms = formulas();
  if (const auto table = table_of(points, FormKind::table)) forms.push_back(*table);
  const bool good = forms.back().kind == FormKind::table && count >= points_of_a_good_table;
  const std::string requested =
      name_of(form_named(calibration.options.form.value_or(good ? TabulatedLaw::name : LogLaw::name)));
  bool found = false;
  for (const FrictionForm& form : forms) {
    // One form more than the points allow is no fault unless it was asked for.
    if (name_of(form) != requested && count <= form.size()) continue;
    if (name_of(form) == requested) {
      calibration.chosen = calibration.forms.size();
      found = true;
    }
    calibration.forms.push_back(
        calibrated(points, form, calibration.options.draws, calibration.options.before_each_draw));
  }
  if (!found)
    throw InputError(
        fmt::format("a table of mu(I) needs at least {} points, there are {}: take --law log, or more runs",
                    points_of_a_table, count));
}

void require_growth(const CalibratedLaw& law) {
  const double middle = std::sqrt(law.I_min * law.I_max);
  const auto faults = faults_of(measured_friction(law.form, law.fit.law, {}, law.I_min, law.I_max));
  if (law.form.kind == FormKind::table || (law.curve().at(middle).slope > 0 && faults.empty())) return;
  if (law.curve().at(middle).slope > 0)
    throw InputError(
        fmt::format("the points between I = {:.2g} and {:.2g} do not determine a law \"{}\": {} {} "
                    "(allowed: {}); take another --law, or runs over a wider range of I",
                    law.I_min, law.I_max, name_of(law.form), faults.front().key, faults.front().what,
                    faults.front().allowed));
  throw InputError(
      fmt::format("mu(I) does not grow with I between {:.2g} and {:.2g} (mu = {:.4f}): such a law has no "
                  "steady flow; calibrate on longer or more accurate runs, or on another range of I",
                  law.I_min, law.I_max, law.fit.law[0]));
}

RheologyFit rheology_of(const Calibration& calibration) {
  const CalibratedLaw& law = calibration.law();
  RheologyFit fit;
  fit.mu = measured_friction(law.form, law.fit.law, law.draws, law.I_min, law.I_max);
  fit.rms_misfit = law.fit.rms_misfit;
  for (const Coefficients& draw : law.draws) {
    if (fit.draws.size() == saved_draws) break;
    FrictionLaw mu = measured_friction(law.form, draw, {}, law.I_min, law.I_max);
    // Few and scattered points, of a small drum, give some that no flow could have.
    if (faults_of(mu).empty()) fit.draws.push_back(std::move(mu));
  }
  if (calibration.options.k) fit.k = measured_stress_ratio(calibration.turn->form, calibration.turn->fit.law);
  const auto runs = static_cast<double>(calibration.runs.size());
  double nu_ci99 = 0;
  for (const RunEvidence& run : calibration.runs) {
    fit.nu += run.nu.value / runs;
    nu_ci99 = std::hypot(nu_ci99, run.nu.ci99.value_or(std::nan("")) / runs);
    fit.fitted_on.push_back(run.name);
  }
  if (std::isfinite(nu_ci99)) fit.nu_ci99 = nu_ci99;
  fit.reduced = calibration.runs.front().reduced;
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

// How far the law is to be trusted.
void assess(Calibration& calibration) {
  const CalibratedLaw& law = calibration.law();
  for (const RunEvidence& run : calibration.runs)
    calibration.scores.push_back(score_of(run.name, friction_of(run, calibration), law));
  for (const RunEvidence& run : calibration.held_out)
    calibration.predictions.push_back(score_of(run.name, friction_of(run, calibration), law));
  const auto speeds = speeds_of(calibration);
  if (speeds.size() > 1) calibration.one_law = one_law_of(speeds, law, calibration.options.draws);
  calibration.ill_posed = ill_posed_intervals(calibration.rheology);
}

}  // namespace

std::vector<FrictionPoint> friction_of(const RunEvidence& run, const Calibration& calibration) {
  if (calibration.options.source == EvidenceSource::profiles) return run.layers;
  // Misalignment alone is looked at, not a part of the law.
  if (!calibration.options.k) return frictions(run.blocks);
  const CalibratedLaw& turn = *calibration.turn;
  return frictions_with_k(run.blocks, stress_ratio_law(measured_stress_ratio(turn.form, turn.fit.law)));
}

SampledAngle sampled_axis_angle(const Calibration& calibration, int intervals) {
  const CalibratedLaw& turn = *calibration.turn;
  const StressRatioLaw k = stress_ratio_law(measured_stress_ratio(turn.form, turn.fit.law));
  const FormCurve mu = calibration.law().curve();
  SampledAngle samples;
  for (int i = 0; i <= intervals; ++i) {
    const double rate_number =
        turn.I_min * std::pow(turn.I_max / turn.I_min, static_cast<double>(i) / intervals);
    const ShearState at = shear_state(k, 0.5 * rate_number, 1);
    const double I = calibration.options.k ? at.I : rate_number;
    // With k, mu is the shear stress over sigma_zz = 2p/(1 + k).
    const double share = calibration.options.k ? 2 / (1 + at.k) : 1;
    samples.I.push_back(I);
    samples.degrees.push_back(turn_angle_deg((at.k - 1) / (at.k + 1), share * mu.at(I).value));
  }
  return samples;
}

Calibration calibration_of(std::vector<RunEvidence> runs, std::vector<RunEvidence> held_out,
                           const CalibrationOptions& options) {
  Calibration calibration;
  calibration.options = options;
  calibration.runs = std::move(runs);
  calibration.held_out = std::move(held_out);
  if (options.k || options.turn) calibration.turn = fitted_turn(calibration);
  fit_forms(calibration);
  require_growth(calibration.law());
  calibration.rheology = rheology_of(calibration);
  assess(calibration);
  return calibration;
}

}  // namespace drumlin::coupling
