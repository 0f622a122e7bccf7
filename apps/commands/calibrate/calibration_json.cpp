#include "apps/commands/calibrate/calibration_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/commands/calibrate/law_json.hpp"
#include "apps/json/json_file.hpp"
#include "coupling/core/documents/json_numbers.hpp"
#include "coupling/core/statistics/straight_line.hpp"

namespace drumlin {
inline void to_json(nlohmann::ordered_json& json, const InertialRange& range) {
  json = {range.from, range.to};
}
}  // namespace drumlin

namespace drumlin::coupling {
DRUMLIN_DESCRIBED(LawScore, run, points, outside_range, rms, bias, inside_prediction, largest, largest_at_I)
DRUMLIN_DESCRIBED(OneLaw, holds, rms_common, rms_own, largest_ratio, difference, at_I, speed)
DRUMLIN_DESCRIBED(SampledAngle, I, degrees)
}  // namespace drumlin::coupling

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

Json form_json(const coupling::CalibratedLaw& law, bool chosen) {
  Json form{{"form", name_of(law.form)},
            {"chosen", chosen},
            {"coefficients", law.fit.law},
            {"rms_misfit", law.fit.rms_misfit},
            {"intrinsic_scatter", law.fit.intrinsic_scatter},
            {"outlier_share", law.fit.outlier_share},
            {"points", law.fit.points}};
  if (!law.form.knots.empty()) {
    form["knots"] = law.form.knots;
    form["intervals_held_well_posed"] = coupling::held_intervals(law.form, law.fit.law);
  } else {
    form["ranges"] = coupling::coefficient_ranges(law);
  }
  form["curve"] = coupling::sampled(law);
  return form;
}

Json points_json(const coupling::RunEvidence& run, const coupling::Calibration& calibration) {
  std::vector<double> I, mu, mu_error, law, angle;
  const coupling::FormCurve curve = calibration.law().curve();
  for (const coupling::FrictionPoint& point : coupling::friction_of(run, calibration)) {
    I.push_back(point.I);
    mu.push_back(point.mu);
    mu_error.push_back(point.mu_error);
    law.push_back(curve.at(point.I).value);
  }
  Json json{
      {"run", run.name}, {"rotation_rpm", run.rotation_rpm}, {"I", I}, {"mu", mu}, {"mu_error", mu_error},
      {"law", law}};
  if (calibration.options.source == coupling::EvidenceSource::profiles || !calibration.turn) return json;
  for (const coupling::LawBlock& point : run.blocks)
    angle.push_back(coupling::turn_angle_deg(point.turn, point.friction.mu));
  json["axis_angle_deg"] = angle;
  return json;
}

Json turn_json(const coupling::Calibration& calibration) {
  const bool maps = calibration.options.source == coupling::EvidenceSource::maps;
  Json json = form_json(*calibration.turn, calibration.options.k);
  json["of"] = maps ? "stress across the strain rate over the pressure" : "k";
  if (!maps) return json;
  json["axis_angle"] = coupling::sampled_axis_angle(calibration);
  return json;
}

/// nu over I of runs in layers, a point each; null without two of them.
Json volume_fractions(const std::vector<coupling::RunEvidence>& runs) {
  Json points = Json::array();
  std::vector<double> I, nu;
  for (const coupling::RunEvidence& run : runs) {
    if (!run.in_layers || run.layers.empty()) continue;
    double sum = 0;
    for (const coupling::FrictionPoint& point : run.layers) sum += point.I;
    I.push_back(sum / static_cast<double>(run.layers.size()));
    nu.push_back(run.nu.value);
    points.push_back(
        {{"run", run.name}, {"I", I.back()}, {"nu", nu.back()}, {"ci99", number_or_null(run.nu.ci99)}});
  }
  const auto line = I.size() < 2 ? std::nullopt : statistics::fit_line(I, nu);
  if (!line) return nullptr;
  return {{"points", points},
          {"at_rest", line->intercept},
          {"slope", line->slope},
          {"rms", std::sqrt(line->chi_squared / static_cast<double>(I.size()))}};
}

Json points_of_all(const coupling::Calibration& calibration) {
  Json json = Json::array();
  for (const auto* group : {&calibration.runs, &calibration.held_out})
    for (const coupling::RunEvidence& run : *group) {
      Json points = points_json(run, calibration);
      points["held_out"] = group == &calibration.held_out;
      json.push_back(std::move(points));
    }
  return json;
}

}  // namespace

Json calibration_json(const coupling::Calibration& calibration, const std::vector<MeasuredRun>& runs) {
  const coupling::CalibratedLaw& law = calibration.law();
  Json json{{"format", "drumlin-calibration-1"},
            {"reduced", calibration.rheology.reduced},
            {"source", name_of(calibration.options.source)},
            {"range_of_validity", {law.I_min, law.I_max}},
            {"well_posed", calibration.ill_posed.empty()},
            {"ill_posed_I", calibration.ill_posed}};
  json["forms"] = Json::array();
  for (std::size_t f = 0; f < calibration.forms.size(); ++f)
    json["forms"].push_back(form_json(calibration.forms[f], f == calibration.chosen));
  json["turn"] = calibration.turn ? turn_json(calibration) : Json();
  json["runs"] = calibration.scores;
  json["held_out"] = calibration.predictions;
  json["one_law"] = calibration.one_law ? Json(*calibration.one_law) : Json();
  if (const Json fractions = volume_fractions(calibration.runs); !fractions.is_null())
    json["volume_fraction"] = fractions;
  json["unsteady"] = Json::array();
  for (const MeasuredRun& run : runs)
    for (const std::string& reason : run.unsteady)
      json["unsteady"].push_back({{"run", run.name}, {"reason", reason}});
  json["points"] = points_of_all(calibration);
  json["provenance"] = provenance();
  std::vector<std::string> edits;
  for (const MeasuredRun& run : runs) edits.insert(edits.end(), run.accepted.begin(), run.accepted.end());
  add_accepted_edits(json["provenance"], edits);
  return json;
}

}  // namespace drumlin::apps
