#include "apps/json/comparison_json.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "apps/json/json_file.hpp"
#include "coupling/core/documents/json_numbers.hpp"

namespace drumlin::apps {

using Json = nlohmann::ordered_json;

namespace {

/// The particles' numbers are measurements: {"value", "ci99"}; the continuum's are plain numbers.
Json particles_of(const coupling::ScalarPair& pair) {
  return to_json(
      Scalar{pair.name, pair.particles, pair.ci99.value_or(std::numeric_limits<double>::quiet_NaN())});
}

Json to_json(const coupling::FieldErrors& errors, const coupling::FieldErrors* floor) {
  Json json{{"rel_l2", number_or_null(errors.rel_l2)},
            {"rms", number_or_null(errors.rms)},
            {"max", number_or_null(errors.max)},
            {"max_at", {{"x", number_or_null(errors.max_x)}, {"z", number_or_null(errors.max_z)}}},
            {"inside_band", number_or_null(errors.inside_band)},
            {"inside_both_bands", number_or_null(errors.inside_both)},
            {"explained",
             {{"calibration", number_or_null(errors.explained_by_calibration)},
              {"particles", number_or_null(errors.explained_by_particles)},
              {"both", number_or_null(errors.explained_by_both)}}},
            {"interval_rms", number_or_null(errors.interval_rms)},
            {"particles_rms", number_or_null(errors.particles_rms)},
            {"layers", errors.layers},
            {"undefined", errors.undefined},
            {"noise", errors.noise}};
  if (floor != nullptr) {
    json["floor_rel_l2"] = number_or_null(floor->rel_l2);
    json["floor_rms"] = number_or_null(floor->rms);
  }
  return json;
}

/// Errors by field and zone; a field that a side does not have is null.
Json errors_of(const std::vector<coupling::FieldComparison>& fields,
               const std::vector<coupling::FieldComparison>* floor) {
  Json errors;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string& name = fields[i].overlay.field;
    if (!fields[i].overlay.present) {
      errors[name] = nullptr;
      continue;
    }
    for (std::size_t k = 0; k < fields[i].zones.size(); ++k) {
      const auto& [zone, found] = fields[i].zones[k];
      errors[name][zone.name] = to_json(found, floor == nullptr ? nullptr : &(*floor)[i].zones[k].errors);
    }
  }
  return errors;
}

Json zones_of(const std::vector<coupling::FieldComparison>& fields) {
  Json zones = Json::object();
  if (!fields.empty())
    for (const auto& [zone, found] : fields.front().zones)
      zones[zone.name] = {{"from", number_or_null(zone.from)}, {"to", number_or_null(zone.to)}};
  return zones;
}

void add_slices(Json& content, const coupling::Comparison& comparison, const coupling::Comparison* floor) {
  const auto& slices = comparison.slices;
  content["slices"] = slices.missing.empty() ? Json::array() : Json();
  content["slices_missing"] = slices.missing.empty() ? Json() : Json(slices.missing);
  for (std::size_t i = 0; i < slices.part.size(); ++i) {
    const coupling::SliceComparison& slice = slices.part[i];
    const bool with_floor = floor != nullptr && floor->slices.part.size() == slices.part.size();
    content["slices"].push_back(
        {{"position", slice.position},
         {"H", number_or_null(slice.H)},
         {"offset", number_or_null(slice.offset)},
         {"zones", zones_of(slice.fields)},
         {"errors", errors_of(slice.fields, with_floor ? &floor->slices.part[i].fields : nullptr)}});
  }
}

void add_maps(Json& content, const coupling::Comparison& comparison, const coupling::Comparison* floor) {
  const auto& maps = comparison.maps;
  content["maps"] = nullptr;
  content["maps_missing"] = maps.missing.empty() ? Json() : Json(maps.missing);
  if (!maps.missing.empty()) return;
  Json zones;
  for (const coupling::MapZone& zone : maps.part.zones) zones[zone.name] = {{"nodes", zone.nodes.size()}};
  const bool with_floor = floor != nullptr && floor->maps.missing.empty();
  content["maps"] = {
      {"offset", number_or_null(maps.part.offset)},
      {"zones", zones},
      {"errors", errors_of(maps.part.fields, with_floor ? &floor->maps.part.fields : nullptr)}};
}

Json to_json(const coupling::ScalarPair& pair) {
  Json continuum = pair.continuum_ci99 ? apps::to_json(Scalar{"", pair.continuum, pair.continuum_ci99})
                                       : number_or_null(pair.continuum);
  Json json{{"particles", particles_of(pair)}, {"continuum", continuum}};
  if (std::isfinite(pair.continuum_own)) json["continuum_own"] = number_or_null(pair.continuum_own);
  return json;
}

}  // namespace

Json to_json(const coupling::Target& target) {
  Json json{{"quantity", target.quantity}};
  if (!target.zone.empty()) json["zone"] = target.zone;
  json["measure"] = target.measure;
  json["limit"] = target.limit;
  json["value"] = number_or_null(target.value);
  json["outcome"] = name_of(target.outcome);
  json["judged_by"] = name_of(target.judged_by);
  if (target.judged_by == coupling::JudgedBy::noise_floor)
    json["noise_floor"] = number_or_null(target.noise_floor);
  if (!target.remark.empty()) json["remark"] = target.remark;
  return json;
}

Json counts_of(const std::vector<coupling::Target>& targets) {
  Json counts{{"met", 0}, {"missed", 0}, {"not_measured", 0}, {"by_noise_floor", 0}};
  const auto count = [&](const std::string& what) { counts[what] = counts[what].get<int>() + 1; };
  for (const coupling::Target& target : targets) {
    count(name_of(target.outcome));
    if (target.judged_by == coupling::JudgedBy::noise_floor) count("by_noise_floor");
  }
  return counts;
}

void add_comparison(Json& content, const coupling::Comparison& comparison,
                    const coupling::Comparison* floor) {
  Json targets = Json::array();
  for (std::size_t i = 0; i < comparison.targets.size(); ++i) {
    targets.push_back(to_json(comparison.targets[i]));
    if (floor != nullptr) targets.back()["floor"] = number_or_null(floor->targets[i].value);
  }
  Json scalars;
  for (const auto& pair : comparison.scalars) scalars[pair.name] = to_json(pair);
  content["verdict"] = counts_of(comparison.targets);
  content["registration"] = {{"by", name_of(comparison.registration)},
                             {"offset", number_or_null(comparison.offset)}};
  content["zones"] = zones_of(comparison.fields);
  content["errors"] = errors_of(comparison.fields, floor == nullptr ? nullptr : &floor->fields);
  content["scalars"] = scalars;
  content["targets"] = targets;
  add_slices(content, comparison, floor);
  add_maps(content, comparison, floor);
}

void add_layer_comparison(Json& content, const coupling::LayerComparison& comparison,
                          const coupling::LayerComparison* floor) {
  const auto extent = [](const coupling::LayerExtent& side) {
    return Json{{"base", number_or_null(side.base)},
                {"top", number_or_null(side.top)},
                {"height", number_or_null(side.height())}};
  };
  Json scalars;
  for (const auto& pair : comparison.scalars) scalars[pair.name] = to_json(pair);
  content["geometry"] = name_of(comparison.geometry);
  content["registration"] = {
      {"by", comparison.registration == coupling::Registration::axis ? "base" : "surface"},
      {"offset", number_or_null(comparison.offset)},
      {"particles", extent(comparison.first)},
      {"continuum", extent(comparison.second)}};
  content["zones"] = zones_of(comparison.fields);
  content["errors"] = errors_of(comparison.fields, floor == nullptr ? nullptr : &floor->fields);
  content["scalars"] = scalars;
}

void add_paper(Json& content, std::optional<double> rotation_rpm,
               const std::vector<coupling::PaperRow>& rows) {
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
    json["continuum"] = number_or_null(row.ours.continuum);
    json["accepted_difference"] = number_or_null(row.accepted);
    json["particles_outcome"] = name_of(row.particles);
    json["continuum_outcome"] = name_of(row.continuum);
    table.push_back(json);
  }
  content["paper"] = {{"rotation_rpm", *rotation_rpm}, {"rows", table}};
}

}  // namespace drumlin::apps
