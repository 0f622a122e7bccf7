#include "apps/support/comparison_json.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "apps/support/json_file.hpp"

namespace drumlin::apps {

using Json = nlohmann::ordered_json;
using Outcome = Target::Outcome;

namespace {

Json number(double value) { return to_json(Scalar{"", value, std::nullopt}); }

/// The particles' numbers are measurements: {"value", "ci99"}; the continuum's are plain numbers.
Json particles_of(const ScalarPair& pair) {
  return to_json(
      Scalar{pair.name, pair.particles, pair.ci99.value_or(std::numeric_limits<double>::quiet_NaN())});
}

Json to_json(const FieldErrors& errors) {
  return {{"rel_l2", number(errors.rel_l2)}, {"rms", number(errors.rms)},
          {"max", number(errors.max)},       {"inside_band", number(errors.inside_band)},
          {"layers", errors.layers},         {"undefined", errors.undefined}};
}

Json to_json(const Target& target) {
  Json json{{"quantity", target.quantity}};
  if (!target.zone.empty()) json["zone"] = target.zone;
  json["measure"] = target.measure;
  json["limit"] = target.limit;
  json["value"] = number(target.value);
  json["outcome"] = name_of(target.outcome);
  if (!target.remark.empty()) json["remark"] = target.remark;
  return json;
}

}  // namespace

std::string name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::met:
      return "met";
    case Outcome::missed:
      return "missed";
    case Outcome::not_measured:
      return "not_measured";
  }
  return {};
}

void add_comparison(Json& content, const Comparison& comparison) {
  Json counts{{"met", 0}, {"missed", 0}, {"not_measured", 0}};
  Json targets = Json::array();
  for (const auto& target : comparison.targets) {
    counts[name_of(target.outcome)] = counts[name_of(target.outcome)].get<int>() + 1;
    targets.push_back(to_json(target));
  }
  content["verdict"] = counts;
  Json zones, errors, scalars;
  for (const auto& field : comparison.fields)
    for (const auto& [zone, found] : field.zones) {
      zones[zone.name] = {{"from", number(zone.from)}, {"to", number(zone.to)}};
      errors[field.overlay.field][zone.name] = to_json(found);
    }
  for (const auto& pair : comparison.scalars)
    scalars[pair.name] = {{"particles", particles_of(pair)}, {"continuum", number(pair.continuum)}};
  content["zones"] = zones;
  content["errors"] = errors;
  content["scalars"] = scalars;
  content["targets"] = targets;
}

void add_paper(Json& content, std::optional<double> rotation_rpm, const std::vector<PaperRow>& rows) {
  if (!rotation_rpm) {
    content["paper"] = nullptr;
    return;
  }
  Json table = Json::array();
  for (const auto& row : rows) {
    Json json{{"name", row.paper.name}, {"paper", row.paper.value}};
    if (row.paper.half_width) json["paper_half_width"] = *row.paper.half_width;
    json["source"] = row.paper.source;
    if (!row.paper.remark.empty()) json["remark"] = row.paper.remark;
    json["particles"] = particles_of(row.ours);
    json["continuum"] = number(row.ours.continuum);
    json["accepted_difference"] = number(row.accepted);
    json["particles_outcome"] = name_of(row.particles);
    json["continuum_outcome"] = name_of(row.continuum);
    table.push_back(json);
  }
  content["paper"] = {{"rotation_rpm", *rotation_rpm}, {"rows", table}};
}

}  // namespace drumlin::apps
