#include "apps/support/study_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "apps/support/enum_name.hpp"
#include "apps/support/json_file.hpp"
#include "coupling/documents/json_numbers.hpp"
#include "coupling/law/law_curve.hpp"

namespace drumlin::apps {

using Json = nlohmann::ordered_json;

namespace {

Json number(double value) { return number_or_null(value); }

Json measurement(double value, double ci99) { return {{"value", number(value)}, {"ci99", number(ci99)}}; }

Json json_of(const coupling::SpeedLaw& law) {
  Json coefficients = Json::object();
  for (const auto& c : law.coefficients) coefficients[c.name] = measurement(c.value, c.ci99);
  return {{"formula", law.formula},
          {"coefficients", coefficients},
          {"reduced_chi2", number(law.reduced_chi2)},
          {"rms", number(law.rms)},
          {"points", law.points}};
}

Json json_of(const coupling::Collapse& collapse) {
  Json points = Json::array();
  for (const coupling::CollapsePoint& point : collapse.points)
    points.push_back({{"I", point.I},
                      {"mean", point.mean},
                      {"spread", point.spread},
                      {"chi2", point.chi2},
                      {"speeds", point.speeds}});
  return {{"ratio", number(collapse.ratio)},
          {"limit", number(collapse.limit)},
          {"collapse", std::isfinite(collapse.ratio) ? Json(collapse.collapse) : Json()},
          {"spread", number(collapse.spread)},
          {"range", number(collapse.range)},
          {"points", points}};
}

Json curve_of(const LogFriction& law, double I_min, double I_max) {
  return to_json(law_curve(friction_law(law), I_min, I_max));
}

/// The paper's mu = a + b ln I, as a curve over the range of I that both are fitted on; null where it does
/// not apply.
Json paper_friction(const std::vector<coupling::PaperVerdict>& rows) {
  const auto number_of = [&](const char* quantity) {
    for (const coupling::PaperVerdict& row : rows)
      if (row.entry.quantity == quantity) return row.entry.value;
    return std::nan("");
  };
  LogFriction law;
  law.a = number_of("friction.a"), law.b = number_of("friction.b");
  if (!std::isfinite(law.a) || !std::isfinite(law.b)) return {};
  return {{"a", law.a},
          {"b", law.b},
          {"curve", curve_of(law, coupling::LayerSelection{}.I_min, coupling::LayerSelection{}.I_max)}};
}

Json json_of(const coupling::FrictionFit& fit) {
  return {{"a", measurement(fit.law.a, coupling::half_width_99(fit, fit.law.covariance[0]))},
          {"b", measurement(fit.law.b, coupling::half_width_99(fit, fit.law.covariance[2]))},
          {"rms", fit.rms_misfit},
          {"birge_ratio", number(fit.birge_ratio)},
          {"layers", fit.points}};
}

Json json_of(const coupling::FrictionCollapse& friction) {
  Json speeds = Json::array();
  for (const auto& speed : friction.speeds) {
    Json one{{"rotation_rpm", speed.rotation_rpm}};
    one.update(json_of(speed.fit));
    one["rms_about_common"] = speed.rms_about_common;
    speeds.push_back(one);
  }
  Json json = json_of(friction.common);
  json["curve"] = curve_of(friction.common.law, friction.common.law.I_min, friction.common.law.I_max);
  json["rms_own"] = friction.rms_own;
  json["mean_error"] = number(friction.mean_error);
  json["speeds"] = speeds;
  return json;
}

Json json_of(const coupling::ConsistencyRow& row) {
  Json json{{"rotation_rpm", row.rotation_rpm},
            {"Q", to_json(row.Q)},
            {"Q_expected", number(row.Q_expected)},
            {"H", to_json(row.H)},
            {"shear_rate", to_json(row.shear_rate)},
            {"shear_rate_laboratory", to_json(row.shear_rate_laboratory)},
            {"layer_balance", to_json(row.layer_balance)},
            {"H_over_sqrt_Q", to_json(row.H_over_sqrt_Q)}};
  const std::pair<const char*, double> of_the_paper[] = {{"paper_Q", row.paper_Q},
                                                         {"paper_H", row.paper_H},
                                                         {"paper_shear_rate", row.paper_shear_rate},
                                                         {"paper_layer_balance", row.paper_layer_balance},
                                                         {"paper_H_over_sqrt_Q", row.paper_H_over_sqrt_Q}};
  for (const auto& [name, value] : of_the_paper) json[name] = number(value);
  return json;
}

std::string words_of(coupling::PaperEntry::Expects expects) {
  using Expects = coupling::PaperEntry::Expects;
  constexpr EnumName<Expects> names[] = {
      {Expects::value, "value"},       {Expects::zero, "zero"},
      {Expects::not_zero, "not zero"}, {Expects::positive, "positive"},
      {Expects::collapse, "collapse"}, {Expects::no_collapse, "no collapse"}};
  return enum_name(names, expects);
}

Json json_of(const coupling::PaperVerdict& row) {
  const coupling::PaperEntry& entry = row.entry;
  Json json{{"quantity", entry.quantity},
            {"rotation_rpm", entry.rotation_rpm ? Json(*entry.rotation_rpm) : Json()},
            {"expects", words_of(entry.expects)}};
  if (entry.expects == coupling::PaperEntry::Expects::value) json["paper"] = number(entry.value);
  if (entry.half_width) json["paper_half_width"] = *entry.half_width;
  json["ours"] = to_json(row.finding.ours);
  if (entry.expects == coupling::PaperEntry::Expects::zero) json["scale"] = number(row.finding.scale);
  if (entry.expects == coupling::PaperEntry::Expects::collapse ||
      entry.expects == coupling::PaperEntry::Expects::no_collapse)
    json["limit"] = number(row.finding.limit);
  json["verdict"] = name_of(row.verdict);
  json["reason"] = name_of(row.reason);
  json["source"] = entry.source;
  if (!entry.remark.empty()) json["remark"] = entry.remark;
  return json;
}

/// How many entries of the paper's table have each verdict.
Json counts_of(const std::vector<coupling::PaperVerdict>& rows) {
  Json counts = Json::object();
  using coupling::Verdict;
  for (const Verdict verdict : {Verdict::agrees, Verdict::open, Verdict::near, Verdict::differs,
                                Verdict::imposed, Verdict::not_measured}) {
    int n = 0;
    for (const coupling::PaperVerdict& row : rows) n += row.verdict == verdict;
    counts[name_of(verdict)] = n;
  }
  return counts;
}

/// Each run, and each speed with the scalars pooled over its runs.
void add_runs(Json& content, const coupling::Study& study) {
  Json runs = Json::array(), speeds = Json::array();
  for (const coupling::StudyRun& run : study.runs) {
    Json scalars = Json::object();
    add_scalars(scalars, run.scalars);
    runs.push_back({{"name", run.name},
                    {"rotation_rpm", run.rotation_rpm},
                    {"warnings", run.warnings},
                    {"scalars", scalars}});
  }
  for (const coupling::SpeedGroup& group : study.speeds) {
    Json names = Json::array(), scalars = Json::object();
    for (const std::size_t r : group.runs) names.push_back(study.runs[r].name);
    add_scalars(scalars, group.scalars);
    speeds.push_back({{"rotation_rpm", group.rotation_rpm}, {"runs", names}, {"scalars", scalars}});
  }
  content["runs"] = runs;
  content["speeds"] = speeds;
}

void add_laws(Json& content, const coupling::Study& study) {
  Json laws = Json::object(), trends = Json::object(), collapses = Json::object();
  for (const coupling::SpeedLaw& law : study.laws) laws[law.name] = json_of(law);
  for (const coupling::SpeedTrend& trend : study.trends)
    trends[trend.quantity] = {{"mean", to_json(trend.mean)},
                              {"trend", to_json(trend.trend)},
                              {"reduced_chi2", number(trend.reduced_chi2)}};
  for (const coupling::Collapse& collapse : study.collapses) collapses[collapse.column] = json_of(collapse);
  content["laws"] = laws;
  content["over_all_speeds"] = trends;
  content["friction"] = study.friction ? json_of(*study.friction) : Json();
  content["paper_friction"] = paper_friction(study.paper);
  content["collapse"] = collapses;
}

std::string shown(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }

std::string shown(const Scalar& scalar) {
  const bool interval = scalar.ci99 && std::isfinite(*scalar.ci99) && std::isfinite(scalar.value);
  return shown(scalar.value) + (interval ? fmt::format(" +- {:.2g}", *scalar.ci99) : "");
}

std::string paper_words(const coupling::PaperVerdict& row) {
  const coupling::PaperEntry& entry = row.entry;
  switch (entry.expects) {
    case coupling::PaperEntry::Expects::value:
      return shown(entry.value) + (entry.half_width ? fmt::format(" +- {:.2g}", *entry.half_width) : "");
    case coupling::PaperEntry::Expects::collapse:
    case coupling::PaperEntry::Expects::no_collapse:
      return fmt::format("{} (limit {})", words_of(entry.expects), shown(row.finding.limit));
    default:
      return words_of(entry.expects);
  }
}

/// A vertical bar would end the cell.
std::string cell(std::string text) {
  for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2))
    text.insert(at, "\\");
  return text;
}

}  // namespace

std::string name_of(coupling::Verdict verdict) {
  constexpr EnumName<coupling::Verdict> names[] = {
      {coupling::Verdict::agrees, "agrees"},   {coupling::Verdict::open, "open"},
      {coupling::Verdict::near, "near"},       {coupling::Verdict::differs, "differs"},
      {coupling::Verdict::imposed, "imposed"}, {coupling::Verdict::not_measured, "not measured"}};
  return enum_name(names, verdict);
}

std::string name_of(coupling::Reason reason) {
  constexpr EnumName<coupling::Reason> names[] = {
      {coupling::Reason::inside_interval, "inside the interval"},
      {coupling::Reason::inside_wide_interval, "inside a wide interval"},
      {coupling::Reason::within_ten_percent, "within 10 %"},
      {coupling::Reason::outside, "outside the interval"},
      {coupling::Reason::unresolved, "the interval holds zero"},
      {coupling::Reason::given_by_the_scene, "fill and speed give it"},
      {coupling::Reason::absent, "not measured"}};
  return enum_name(names, reason);
}

void add_study(Json& content, const coupling::Study& study) {
  content["warnings"] = study.warnings;
  content["verdict"] = study.paper.empty() ? Json() : counts_of(study.paper);
  add_runs(content, study);
  add_laws(content, study);
  Json consistency = Json::array(), paper = Json::array();
  for (const coupling::ConsistencyRow& row : study.consistency) consistency.push_back(json_of(row));
  for (const coupling::PaperVerdict& row : study.paper) paper.push_back(json_of(row));
  content["consistency"] = consistency;
  content["paper_table"] = study.paper.empty() ? Json() : paper;
}

std::string paper_table_markdown(const coupling::Study& study) {
  if (study.paper.empty()) return "This drum is none of the paper's six; its numbers do not apply.\n";
  std::string text =
      "| quantity | rpm | paper | ours (99 %) | verdict | why | where in the paper "
      "|\n|---|---|---|---|---|---|---|\n";
  for (const coupling::PaperVerdict& row : study.paper)
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", row.entry.quantity,
                        row.entry.rotation_rpm ? shown(*row.entry.rotation_rpm) : "all", paper_words(row),
                        shown(row.finding.ours),
                        row.verdict == coupling::Verdict::differs ? "**differs**" : name_of(row.verdict),
                        name_of(row.reason), cell(row.entry.source));
  return text;
}

}  // namespace drumlin::apps
