#include "apps/commands/calibrate/calibration_json.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/support/json_file.hpp"

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr int curve_points = 60;

Json numbers(const std::vector<double>& values) { return Json(values); }

// The law and its 99 % band over its range.
Json curve_of(const CalibratedLaw& law) {
  std::vector<double> I, value, low, high;
  for (int i = 0; i <= curve_points; ++i) {
    const double at = law.I_min * std::pow(law.I_max / law.I_min, static_cast<double>(i) / curve_points);
    const FrictionBand band = band_at(law.form, law.draws, at);
    I.push_back(at);
    value.push_back(friction(law.form, law.fit.law, at));
    low.push_back(band.low);
    high.push_back(band.high);
  }
  return {{"I", numbers(I)}, {"value", numbers(value)}, {"low", numbers(low)}, {"high", numbers(high)}};
}

Json form_json(const CalibratedLaw& law, bool chosen) {
  Json form{{"form", name_of(law.form.kind)},
            {"chosen", chosen},
            {"coefficients", numbers(law.fit.law)},
            {"rms_misfit", law.fit.rms_misfit},
            {"intrinsic_scatter", law.fit.intrinsic_scatter},
            {"outlier_share", law.fit.outlier_share},
            {"points", law.fit.points}};
  if (law.form.kind == FormKind::table) {
    form["knots"] = numbers(law.form.knots);
    form["intervals_held_well_posed"] = law.form.growing ? held_intervals(law.form, law.fit.law) : 0;
  }
  form["curve"] = curve_of(law);
  return form;
}

Json score_json(const LawScore& score) {
  return {{"run", score.run},
          {"points", score.points},
          {"outside_range", score.outside},
          {"rms", score.rms},
          {"bias", score.bias},
          {"inside_prediction", score.inside_prediction},
          {"largest", score.largest},
          {"largest_at_I", score.largest_at_I}};
}

Json points_json(const RunEvidence& run, const Calibration& calibration) {
  std::vector<double> I, mu, mu_error, angle;
  for (const FrictionPoint& point : friction_of(run, calibration)) {
    I.push_back(point.I);
    mu.push_back(point.mu);
    mu_error.push_back(point.mu_error);
  }
  Json json{{"run", run.run.name},
            {"rotation_rpm", run.rotation_rpm},
            {"I", numbers(I)},
            {"mu", numbers(mu)},
            {"mu_error", numbers(mu_error)}};
  if (calibration.source == Source::profiles || !calibration.turn) return json;
  for (const LawBlock& point : run.blocks)
    angle.push_back(std::atan2(point.turn, point.friction.mu) * 90 / std::numbers::pi);
  json["axis_angle_deg"] = numbers(angle);
  return json;
}

Json turn_json(const Calibration& calibration) {
  const CalibratedLaw& turn = *calibration.turn;
  Json json = form_json(turn, calibration.with_k);
  json["of"] = calibration.source == Source::maps ? "stress across the strain rate over the pressure" : "k";
  if (calibration.source == Source::profiles) return json;
  const CalibratedLaw& law = calibration.law();
  std::vector<double> angle;
  for (const double I : turn.form.knots)
    angle.push_back(std::atan2(friction(turn.form, turn.fit.law, I), friction(law.form, law.fit.law, I)) *
                    90 / std::numbers::pi);
  json["axis_angle_deg"] = numbers(angle);
  return json;
}

}  // namespace

Json calibration_json(const Calibration& calibration) {
  const CalibratedLaw& law = calibration.law();
  Json json{{"format", "drumlin-calibration-1"},
            {"reduced", calibration.rheology.reduced},
            {"source", calibration.source == Source::maps ? "maps" : "profiles"},
            {"range_of_validity", {law.I_min, law.I_max}},
            {"well_posed", calibration.ill_posed.empty()}};
  json["ill_posed_I"] = Json::array();
  for (const IllPosed& range : calibration.ill_posed) json["ill_posed_I"].push_back({range.from, range.to});
  json["forms"] = Json::array();
  for (std::size_t f = 0; f < calibration.forms.size(); ++f)
    json["forms"].push_back(form_json(calibration.forms[f], f == calibration.chosen));
  json["turn"] = calibration.turn ? turn_json(calibration) : Json();
  json["runs"] = Json::array();
  for (const LawScore& score : calibration.scores) json["runs"].push_back(score_json(score));
  json["held_out"] = Json::array();
  for (const LawScore& score : calibration.predictions) json["held_out"].push_back(score_json(score));
  json["one_law"] = Json();
  if (calibration.one_law) {
    const OneLaw& one = *calibration.one_law;
    json["one_law"] = {{"holds", one.holds},
                       {"rms_common", one.rms_common},
                       {"rms_own", one.rms_own},
                       {"largest_ratio", one.largest_ratio},
                       {"difference", one.difference},
                       {"at_I", one.at_I},
                       {"speed", one.speed}};
  }
  json["relaxation"] = Json::array();
  for (std::size_t r = 0; r < calibration.relaxations.size(); ++r) {
    const FabricRelaxation& found = calibration.relaxations[r];
    json["relaxation"].push_back({{"run", calibration.runs[r].run.name},
                                  {"c", found.c},
                                  {"ci99", found.ci99},
                                  {"explained", found.explained},
                                  {"points", found.points}});
  }
  json["unsteady"] = Json::array();
  json["points"] = Json::array();
  for (const auto* group : {&calibration.runs, &calibration.held_out})
    for (const RunEvidence& run : *group) {
      for (const std::string& reason : run.run.unsteady)
        json["unsteady"].push_back({{"run", run.run.name}, {"reason", reason}});
      Json points = points_json(run, calibration);
      points["held_out"] = group == &calibration.held_out;
      json["points"].push_back(std::move(points));
    }
  json["provenance"] = to_json(provenance());
  return json;
}

}  // namespace drumlin::apps
