#include "coupling/comparison/targets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "coupling/core/basics/no_value.hpp"

namespace drumlin::coupling {

namespace {

struct FieldTarget {
  const char* field;
  const char* zone;
  double FieldErrors::*measure;
  const char* words;
  double limit;
};
constexpr FieldTarget field_targets[] = {
    {"sigma_zz", "all", &FieldErrors::rel_l2, "relative", 0.05},
    {"sigma_xz", "flowing", &FieldErrors::rel_l2, "relative", 0.05},
    {"sigma_xz", "static", &FieldErrors::rel_l2, "relative", 0.15},
    {"sigma_xx", "all", &FieldErrors::rel_l2, "relative", 0.15},
    // A 1 % error of stress is a 30 % error of velocity with this law: velocity is the hard field.
    {"v_x", "flowing", &FieldErrors::rel_l2, "relative", 0.20},
    {"log10_shear_rate", "static", &FieldErrors::rms, "decades", 0.3},
    {"axis_angle_deg", "all", &FieldErrors::rms, "deg", 5},
};

struct ScalarTarget {
  const char* name;
  bool relative;
  const char* words;
  double limit;
};
constexpr ScalarTarget scalar_targets[] = {
    {"theta_deg", false, "deg", 1},
    {"Q", true, "relative", 0.01},
    {"H", false, "d", 2},
    {"lambda", true, "relative", 0.15},
};

Outcome outcome_of(double value, double limit) {
  if (std::isnan(value)) return Outcome::not_measured;
  return value <= limit ? Outcome::met : Outcome::missed;
}

void add_remark(Target& target, const std::string& text) {
  target.remark += (target.remark.empty() ? "" : "; ") + text;
}

/// What the particles' own intervals amount to over a zone, by the same measure as the error.
double interval_of(const FieldComparison& field, const std::string& name, bool relative) {
  for (const auto& [zone, errors] : field.zones)
    if (zone.name == name) return relative ? errors.interval_rms / errors.particles_rms : errors.interval_rms;
  return no_value;
}

/// Judges a target whose value is known, by its limit or by what the particles leave open.
void judge(Target& target, double open) {
  const bool noisy = open > target.limit;
  target.judged_by = noisy ? JudgedBy::noise_floor : JudgedBy::limit;
  target.noise_floor = noisy ? open : no_value;
  target.outcome = outcome_of(target.value, noisy ? open : target.limit);
  if (noisy) add_remark(target, fmt::format("the particles' own interval amounts to {:.2g}", open));
}

Target assessed(const FieldTarget& requirement, const std::vector<FieldComparison>& fields) {
  Target target{requirement.field,
                requirement.zone,
                requirement.words,
                requirement.limit,
                no_value,
                Outcome::not_measured,
                ""};
  const auto field = std::find_if(fields.begin(), fields.end(), [&](const FieldComparison& candidate) {
    return candidate.overlay.field == requirement.field;
  });
  if (field == fields.end()) return target;
  if (!field->overlay.present) target.remark = "a side has no such field";
  for (const auto& [zone, errors] : field->zones) {
    if (zone.name != requirement.zone) continue;
    target.value = errors.*requirement.measure;
    judge(target, interval_of(*field, zone.name, requirement.measure == &FieldErrors::rel_l2));
    if (errors.undefined > 0) {
      target.undefined = true;
      target.outcome = Outcome::missed;
      add_remark(target, std::to_string(errors.undefined) + " of " +
                             std::to_string(errors.undefined + errors.layers) +
                             " layers undefined in the continuum");
    } else if (errors.layers == 0 && target.remark.empty()) {
      target.remark = "no layer in this zone";
    }
  }
  return target;
}

Target assessed(const ScalarTarget& requirement, const std::vector<ScalarPair>& scalars) {
  Target target{requirement.name,      "", requirement.words, requirement.limit, no_value,
                Outcome::not_measured, ""};
  for (const auto& pair : scalars) {
    if (pair.name != requirement.name) continue;
    const double difference = std::abs(pair.continuum - pair.particles);
    target.value = requirement.relative ? difference / std::abs(pair.particles) : difference;
    judge(target, pair.ci99.value_or(no_value) / (requirement.relative ? std::abs(pair.particles) : 1));
    if (std::isnan(pair.particles)) target.remark = "not measured on the particles";
    if (std::isnan(pair.continuum)) target.remark = "not computed by the continuum";
  }
  return target;
}

}  // namespace

std::vector<Target> judged_targets(const std::vector<FieldComparison>& fields,
                                   const std::vector<ScalarPair>& scalars) {
  std::vector<Target> targets;
  for (const auto& requirement : field_targets) targets.push_back(assessed(requirement, fields));
  for (const auto& requirement : scalar_targets) targets.push_back(assessed(requirement, scalars));
  return targets;
}

void judge_by_floor(std::vector<Target>& targets, const std::vector<Target>& floor) {
  for (std::size_t i = 0; i < targets.size(); ++i) {
    Target& target = targets[i];
    if (target.judged_by == JudgedBy::limit || !(floor[i].value > target.noise_floor)) continue;
    target.noise_floor = floor[i].value;
    if (target.value <= target.noise_floor && !target.undefined) target.outcome = Outcome::met;
  }
}

}  // namespace drumlin::coupling
