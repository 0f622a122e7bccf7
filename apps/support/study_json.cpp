#include "apps/support/study_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/support/json_file.hpp"

namespace drumlin::apps {

using Json = nlohmann::ordered_json;

namespace {

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json measurement(double value, double ci99) { return {{"value", number(value)}, {"ci99", number(ci99)}}; }

Json json_of(const SpeedLaw& law) {
  Json coefficients = Json::object();
  for (const auto& c : law.coefficients) coefficients[c.name] = measurement(c.value, c.ci99);
  return {{"formula", law.formula},
          {"coefficients", coefficients},
          {"reduced_chi2", number(law.reduced_chi2)},
          {"rms", number(law.rms)},
          {"points", law.points}};
}

Json json_of(const Collapse& collapse) {
  Json points = Json::array();
  for (const CollapsePoint& point : collapse.points)
    points.push_back({{"I", point.I},
                      {"mean", point.mean},
                      {"spread", point.spread},
                      {"chi2", point.chi2},
                      {"speeds", point.speeds}});
  return {{"ratio", number(collapse.ratio)}, {"limit", number(collapse.limit)},
          {"collapse", collapse.collapse},   {"spread", number(collapse.spread)},
          {"range", number(collapse.range)}, {"points", points}};
}

Json json_of(const FrictionFit& fit) {
  constexpr double quantile_99 = 2.576;
  return {{"a", measurement(fit.law.a, quantile_99 * std::sqrt(fit.law.covariance[0]))},
          {"b", measurement(fit.law.b, quantile_99 * std::sqrt(fit.law.covariance[2]))},
          {"rms", fit.rms_misfit},
          {"birge_ratio", number(fit.birge_ratio)},
          {"layers", fit.points}};
}

Json json_of(const FrictionCollapse& friction) {
  Json speeds = Json::array();
  for (const auto& speed : friction.speeds) {
    Json one{{"rotation_rpm", speed.rotation_rpm}};
    one.update(json_of(speed.fit));
    one["rms_about_common"] = speed.rms_about_common;
    speeds.push_back(one);
  }
  Json json = json_of(friction.common);
  json["rms_own"] = friction.rms_own;
  json["mean_error"] = number(friction.mean_error);
  json["speeds"] = speeds;
  return json;
}

Json json_of(const ConsistencyRow& row) {
  return {{"rotation_rpm", row.rotation_rpm},
          {"Q", to_json(row.Q)},
          {"Q_expected", number(row.Q_expected)},
          {"H", to_json(row.H)},
          {"shear_rate", to_json(row.shear_rate)},
          {"shear_rate_laboratory", to_json(row.shear_rate_laboratory)},
          {"layer_balance", to_json(row.layer_balance)},
          {"H_over_sqrt_Q", to_json(row.H_over_sqrt_Q)},
          {"paper_Q", number(row.paper_Q)},
          {"paper_H", number(row.paper_H)},
          {"paper_shear_rate", number(row.paper_shear_rate)},
          {"paper_layer_balance", number(row.paper_layer_balance)},
          {"paper_H_over_sqrt_Q", number(row.paper_H_over_sqrt_Q)}};
}

std::string words_of(PaperEntry::Expects expects) {
  switch (expects) {
    case PaperEntry::Expects::value:
      return "value";
    case PaperEntry::Expects::zero:
      return "zero";
    case PaperEntry::Expects::not_zero:
      return "not zero";
    case PaperEntry::Expects::positive:
      return "positive";
    case PaperEntry::Expects::collapse:
      return "collapse";
    case PaperEntry::Expects::no_collapse:
      return "no collapse";
  }
  return "";
}

Json json_of(const PaperVerdict& row) {
  const PaperEntry& entry = row.entry;
  Json json{{"quantity", entry.quantity},
            {"rotation_rpm", entry.rotation_rpm ? Json(*entry.rotation_rpm) : Json()},
            {"expects", words_of(entry.expects)}};
  if (entry.expects == PaperEntry::Expects::value) json["paper"] = number(entry.value);
  if (entry.half_width) json["paper_half_width"] = *entry.half_width;
  json["ours"] = to_json(row.finding.ours);
  if (entry.expects == PaperEntry::Expects::zero) json["scale"] = number(row.finding.scale);
  if (entry.expects == PaperEntry::Expects::collapse || entry.expects == PaperEntry::Expects::no_collapse)
    json["limit"] = number(row.finding.limit);
  json["verdict"] = name_of(row.verdict);
  json["reason"] = name_of(row.reason);
  json["source"] = entry.source;
  if (!entry.remark.empty()) json["remark"] = entry.remark;
  return json;
}

std::string shown(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "-"; }

std::string shown(const Scalar& scalar) {
  const bool interval = scalar.ci99 && std::isfinite(*scalar.ci99) && std::isfinite(scalar.value);
  return shown(scalar.value) + (interval ? fmt::format(" +- {:.2g}", *scalar.ci99) : "");
}

std::string paper_words(const PaperVerdict& row) {
  const PaperEntry& entry = row.entry;
  switch (entry.expects) {
    case PaperEntry::Expects::value:
      return shown(entry.value) + (entry.half_width ? fmt::format(" +- {:.2g}", *entry.half_width) : "");
    case PaperEntry::Expects::collapse:
    case PaperEntry::Expects::no_collapse:
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

std::string name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::agrees:
      return "agrees";
    case Verdict::near:
      return "near";
    case Verdict::differs:
      return "differs";
    case Verdict::not_measured:
      return "not measured";
  }
  return "";
}

std::string name_of(Reason reason) {
  switch (reason) {
    case Reason::inside_interval:
      return "inside the interval";
    case Reason::inside_wide_interval:
      return "inside a wide interval";
    case Reason::within_ten_percent:
      return "within 10 %";
    case Reason::outside:
      return "outside the interval";
    case Reason::unresolved:
      return "the interval holds zero";
    case Reason::absent:
      return "not measured";
  }
  return "";
}

void add_study(Json& content, const Study& study) {
  content["warnings"] = study.warnings;
  Json counts = Json::object();
  for (const Verdict verdict : {Verdict::agrees, Verdict::near, Verdict::differs, Verdict::not_measured}) {
    int n = 0;
    for (const PaperVerdict& row : study.paper) n += row.verdict == verdict;
    counts[name_of(verdict)] = n;
  }
  content["verdict"] = study.paper.empty() ? Json() : counts;

  Json runs = Json::array();
  for (const StudyRun& run : study.runs) {
    Json scalars = Json::object();
    add_scalars(scalars, run.scalars);
    runs.push_back({{"name", run.name},
                    {"rotation_rpm", run.rotation_rpm},
                    {"warnings", run.warnings},
                    {"scalars", scalars}});
  }
  content["runs"] = runs;
  Json speeds = Json::array();
  for (const SpeedGroup& group : study.speeds) {
    Json names = Json::array(), scalars = Json::object();
    for (const std::size_t r : group.runs) names.push_back(study.runs[r].name);
    add_scalars(scalars, group.scalars);
    speeds.push_back({{"rotation_rpm", group.rotation_rpm}, {"runs", names}, {"scalars", scalars}});
  }
  content["speeds"] = speeds;

  Json laws = Json::object(), trends = Json::object(), collapses = Json::object();
  for (const SpeedLaw& law : study.laws) laws[law.name] = json_of(law);
  for (const SpeedTrend& trend : study.trends)
    trends[trend.quantity] = {{"mean", to_json(trend.mean)},
                              {"trend", to_json(trend.trend)},
                              {"reduced_chi2", number(trend.reduced_chi2)}};
  for (const Collapse& collapse : study.collapses) collapses[collapse.column] = json_of(collapse);
  content["laws"] = laws;
  content["over_all_speeds"] = trends;
  content["friction"] = study.friction ? json_of(*study.friction) : Json();
  content["collapse"] = collapses;
  Json consistency = Json::array(), paper = Json::array();
  for (const ConsistencyRow& row : study.consistency) consistency.push_back(json_of(row));
  for (const PaperVerdict& row : study.paper) paper.push_back(json_of(row));
  content["consistency"] = consistency;
  content["paper_table"] = study.paper.empty() ? Json() : paper;
}

std::string paper_table_markdown(const Study& study) {
  if (study.paper.empty()) return "This drum is none of the paper's six; its numbers do not apply.\n";
  std::string text =
      "| quantity | rpm | paper | ours (99 %) | verdict | why | where in the paper "
      "|\n|---|---|---|---|---|---|---|\n";
  for (const PaperVerdict& row : study.paper)
    text += fmt::format("| {} | {} | {} | {} | {} | {} | {} |\n", row.entry.quantity,
                        row.entry.rotation_rpm ? shown(*row.entry.rotation_rpm) : "all", paper_words(row),
                        shown(row.finding.ours),
                        row.verdict == Verdict::differs ? "**differs**" : name_of(row.verdict),
                        name_of(row.reason), cell(row.entry.source));
  return text;
}

}  // namespace drumlin::apps
