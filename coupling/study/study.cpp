#include "coupling/study/study.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "coupling/comparison/comparison.hpp"
#include "coupling/comparison/paper_file.hpp"
#include "coupling/comparison/paper_table.hpp"
#include "coupling/study/run_scalars.hpp"

namespace drumlin::coupling {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double degree = std::numbers::pi / 180;

Scalar absent(const std::string& name) { return {name, nan, std::nullopt}; }

const SpeedGroup* group_at(const Study& study, double rotation_rpm) {
  for (const SpeedGroup& group : study.speeds)
    if (std::abs(group.rotation_rpm - rotation_rpm) <= 0.01 * rotation_rpm) return &group;
  return nullptr;
}

double value_at(const SpeedGroup& group, const std::string& name) {
  const Scalar* found = group.scalars.find(name);
  return found == nullptr ? nan : found->value;
}

Scalar mean_of(const Study& study, const std::string& name) {
  for (const SpeedTrend& trend : study.trends) {
    if (trend.quantity == name) return trend.mean;
    if (trend.trend.name == name) return trend.trend;
  }
  return absent(name);
}

/// Coefficients of the common friction law. Layers of one run move together, which the fit cannot know: the
/// interval is at least that of the speeds' own coefficients about their mean.
Scalar friction_coefficient(const Study& study, bool slope) {
  const std::string name = slope ? "mu_b" : "mu_a";
  if (!study.friction) return absent(name);
  const FrictionFit& fit = study.friction->common;
  const double of_fit = half_width_99(fit, fit.law.covariance[slope ? 2 : 0]);
  const double of_speeds = mean_of(study, name).ci99.value_or(0);
  return {name, slope ? fit.law.b : fit.law.a, std::max(of_fit, of_speeds)};
}

/// LAW.COEFFICIENT of data/paper/laws.toml.
Scalar coefficient_of(const Study& study, const std::string& law, const std::string& coefficient) {
  if (law == "friction") return friction_coefficient(study, coefficient == "b");
  if (law == "static_velocity_fluctuation") return mean_of(study, "dv_exponent");
  if (law == "static_spin_fluctuation") return mean_of(study, "domega_exponent");
  for (const SpeedLaw& candidate : study.laws)
    if (candidate.name == law)
      for (const auto& c : candidate.coefficients)
        if (c.name == coefficient) return {c.name, c.value, c.ci99};
  return absent(law);
}

/// The extreme of the speeds' shear rates.
Scalar extreme_shear_rate(const Study& study, bool highest) {
  Scalar extreme = absent("shear_rate");
  for (const SpeedGroup& group : study.speeds) {
    const Scalar* rate = group.scalars.find("shear_rate");
    if (rate == nullptr || !std::isfinite(rate->value)) continue;
    if (!std::isfinite(extreme.value) || (rate->value > extreme.value) == highest) extreme = *rate;
  }
  return extreme;
}

/// What a derivative along x, said to vanish, is small against: gravity's pull along the slope for stresses,
/// a change by the whole quantity over the 5 d by which the paper moves its slice for the others.
double scale_of(const SpeedGroup& group, const std::string& name) {
  if (name.starts_with("dsigma_"))
    return value_at(group, "nu_bulk") * std::sin(value_at(group, "theta_deg") * degree);
  if (name.starts_with("dnu_dx")) return value_at(group, "nu_bulk") / 5;
  if (name.starts_with("dv_dx")) return value_at(group, "shear_rate") * value_at(group, "H") / 2 / 5;
  return 1;
}

const Node* law_named(const Node::Array& laws, const std::string& name) {
  for (const Node& law : laws)
    if (text_in(law.find("name")) == name) return law.find("coefficients");
  return nullptr;
}

/// The paper's shear rate at a speed: stated, else by its own law.
double paper_shear_rate(const std::filesystem::path& folder, double rotation_rpm, double theta_deg) {
  for (const PaperNumber& number : paper_numbers(folder, rotation_rpm))
    if (number.name == "shear_rate") return number.value;
  const auto laws = paper_entries(paper_file(folder / "laws.toml"), "law");
  const Node* coefficients = law_named(laws, "shear_rate");
  if (coefficients == nullptr) return nan;
  const double Phi = number_in(coefficients->find("Phi_deg")) * degree;
  return number_in(coefficients->find("c")) *
         std::sqrt((std::sin(theta_deg * degree) - std::sin(Phi)) / std::cos(Phi));
}

ConsistencyRow consistency_of(const SpeedGroup& group, const std::filesystem::path& folder, bool is_papers) {
  const auto known = [&](const std::string& name) {
    const Scalar* found = group.scalars.find(name);
    return found == nullptr ? absent(name) : *found;
  };
  ConsistencyRow row;
  row.rotation_rpm = group.rotation_rpm;
  row.Q = known("Q");
  row.H = known("H");
  row.shear_rate = known("shear_rate");
  row.shear_rate_laboratory = known("shear_rate_laboratory");
  row.layer_balance = known("layer_balance");
  row.H_over_sqrt_Q = known("H_over_sqrt_Q");
  row.Q_expected = value_at(group, "Q_expected");
  row.paper_Q = row.paper_H = row.paper_shear_rate = row.paper_layer_balance = row.paper_H_over_sqrt_Q = nan;
  if (!is_papers) return row;
  double theta = nan;
  for (const PaperNumber& number : paper_numbers(folder, std::round(group.rotation_rpm))) {
    if (number.name == "Q") row.paper_Q = number.value;
    if (number.name == "H") row.paper_H = number.value;
    if (number.name == "theta_deg") theta = number.value;
  }
  if (!std::isfinite(row.paper_H)) return row;
  row.paper_shear_rate = paper_shear_rate(folder, std::round(group.rotation_rpm), theta);
  row.paper_layer_balance = linear_layer_share(row.paper_shear_rate, row.paper_H, row.paper_Q);
  row.paper_H_over_sqrt_Q = row.paper_H / std::sqrt(row.paper_Q);
  return row;
}

std::vector<SpeedTrend> trends_of(const std::vector<SpeedGroup>& groups) {
  std::vector<std::string> names;
  for (const SpeedGroup& group : groups)
    for (const Scalar& scalar : group.scalars.scalars)
      if (std::find(names.begin(), names.end(), scalar.name) == names.end()) names.push_back(scalar.name);
  std::vector<SpeedTrend> trends;
  for (const std::string& name : names) trends.push_back(speed_trend(name, groups));
  return trends;
}

}  // namespace

Finding finding_for(const PaperEntry& entry, const Study& study) {
  const std::string& name = entry.quantity;
  if (entry.rotation_rpm) {
    const SpeedGroup* group = group_at(study, *entry.rotation_rpm);
    const Scalar* found = group == nullptr ? nullptr : group->scalars.find(name);
    return found == nullptr ? Finding{absent(name)} : Finding{*found, scale_of(*group, name)};
  }
  if (const auto dot = name.find('.'); dot != std::string::npos)
    return {coefficient_of(study, name.substr(0, dot), name.substr(dot + 1))};
  if (name == "shear_rate_lowest") return {extreme_shear_rate(study, false)};
  if (name == "shear_rate_highest") return {extreme_shear_rate(study, true)};
  for (const Collapse& collapse : study.collapses)
    if (name == collapse.column + "_collapse")
      return {{name, collapse.ratio, std::nullopt}, 1, collapse.limit};
  return {mean_of(study, name)};
}

Study study_of(std::vector<StudyRun> runs, const std::filesystem::path& paper_folder) {
  require_one_study(runs);
  Study study;
  bool is_papers = true;
  for (StudyRun& run : runs) {
    run.scalars = with_derived(run.scalars, run.profiles);
    is_papers = is_papers && paper_speed_rpm(run.profiles, paper_folder).has_value();
    for (const std::string& warning : run.warnings) study.warnings.push_back(run.name + ": " + warning);
    for (const auto& [key, value] : run.numerics) {
      const auto first = runs.front().numerics.find(key);
      if (first == runs.front().numerics.end() || first->second != value)
        study.warnings.push_back(run.name + ": " + key + " = " + value + ", other than in " +
                                 runs.front().name);
    }
  }
  study.runs = std::move(runs);
  study.speeds = speed_groups(study.runs);
  study.laws = speed_laws(study.speeds);
  study.trends = trends_of(study.speeds);
  study.friction = friction_collapse(study.runs, study.speeds);
  for (const char* column : {"mu", "k", "nu"})
    study.collapses.push_back(collapse_of(column, study.runs, study.speeds));
  for (const SpeedGroup& group : study.speeds)
    study.consistency.push_back(consistency_of(group, paper_folder, is_papers));
  if (is_papers)
    for (const PaperEntry& entry : paper_entries_of(paper_folder))
      study.paper.push_back(verdict_on(entry, finding_for(entry, study)));
  return study;
}

}  // namespace drumlin::coupling
