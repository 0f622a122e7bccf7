#include "coupling/comparison/targets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace drumlin {

namespace {

using Outcome = Target::Outcome;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

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

Target judged(const FieldTarget& asked, const std::vector<FieldComparison>& fields) {
  Target target{asked.field, asked.zone, asked.words, asked.limit, nan, Outcome::not_measured, ""};
  const auto field = std::find_if(fields.begin(), fields.end(), [&](const FieldComparison& candidate) {
    return candidate.overlay.field == asked.field;
  });
  if (field == fields.end()) return target;
  for (const auto& [zone, errors] : field->zones) {
    if (zone.name != asked.zone) continue;
    target.value = errors.*asked.measure;
    target.outcome = outcome_of(target.value, target.limit);
    if (errors.undefined > 0) {
      target.outcome = Outcome::missed;
      target.remark = std::to_string(errors.undefined) + " of " +
                      std::to_string(errors.undefined + errors.layers) + " layers undefined in the continuum";
    } else if (errors.layers == 0) {
      target.remark = "no layer in this zone";
    }
  }
  return target;
}

Target judged(const ScalarTarget& asked, const std::vector<ScalarPair>& scalars) {
  Target target{asked.name, "", asked.words, asked.limit, nan, Outcome::not_measured, ""};
  for (const auto& pair : scalars) {
    if (pair.name != asked.name) continue;
    const double difference = std::abs(pair.continuum - pair.particles);
    target.value = asked.relative ? difference / std::abs(pair.particles) : difference;
    target.outcome = outcome_of(target.value, target.limit);
    if (std::isnan(pair.particles)) target.remark = "not measured on the particles";
    if (std::isnan(pair.continuum)) target.remark = "not computed by the continuum";
  }
  return target;
}

}  // namespace

std::vector<Target> judged_targets(const std::vector<FieldComparison>& fields,
                                   const std::vector<ScalarPair>& scalars) {
  std::vector<Target> targets;
  for (const auto& asked : field_targets) targets.push_back(judged(asked, fields));
  for (const auto& asked : scalar_targets) targets.push_back(judged(asked, scalars));
  targets.push_back({"stress_strain_axis_angle", "all", "deg", 5, nan, Outcome::not_measured,
                     "the profiles hold no strain-rate tensor"});
  return targets;
}

}  // namespace drumlin
