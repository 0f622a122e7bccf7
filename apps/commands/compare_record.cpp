#include "apps/commands/compare_record.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/json/json_file.hpp"

namespace drumlin::apps {

namespace {

using Json = nlohmann::ordered_json;

Json entry(const Json& object, const std::string& key) {
  return object.is_object() ? object.value(key, Json()) : Json();
}

Json header_of(const ProfileSet& profiles) {
  Json header;
  for (const auto& [key, value] : header_texts(profiles.header)) header[key] = value;
  return header;
}

/// What a side is and where it comes from.
Json origin_of(const LoadedSide& side) {
  Json origin{
      {"kind", name_of(side.kind)}, {"name", side.name}, {"profiles", header_of(side.compared.profiles)}};
  if (!side.unsteady.empty()) origin["unsteady"] = side.unsteady;
  const Json records = records_of(side);
  origin["run"] = entry(records, "run");
  origin["measurement"] = entry(entry(records, "measured"), "settings");
  origin["flow"] = entry(records, "flow");
  return origin;
}

/// Seconds of a side: how long until its results stood there, and on how much of a processor.
Json seconds_of(const LoadedSide& side) {
  const Json records = records_of(side);
  if (side.kind == RunSide::continuum)
    return {{"wall", entry(entry(records, "flow"), "seconds")},
            {"processor", entry(entry(records, "flow"), "cpu_seconds")},
            {"measurement", nullptr}};
  return {{"wall", entry(entry(records, "run"), "wall_seconds")},
          {"processor", entry(entry(records, "run"), "cpu_seconds")},
          {"measurement", entry(entry(records, "measured"), "seconds")}};
}

Json ratio(const Json& above, const Json& below) {
  if (!above.is_number() || !below.is_number() || !(below.get<double>() > 0)) return nullptr;
  return above.get<double>() / below.get<double>();
}

}  // namespace

void add_costs(Json& content, const ComparedRuns& runs) {
  const Json first = seconds_of(runs.first), second = seconds_of(runs.second);
  const std::string run = name_of(runs.first.kind), solve = name_of(runs.second.kind);
  content["costs"] = {{run + " run, wall", first["wall"]},
                      {run + " run, processor", first["processor"]},
                      {"measurement, wall", first["measurement"]},
                      {solve + " solve, wall", second["wall"]},
                      {solve + " solve, processor", second["processor"]}};
  content["cost_ratio"] = {{"wall", ratio(first["wall"], second["wall"])},
                           {"processor", ratio(first["processor"], second["processor"])}};
}

std::string title_of(const ComparedRuns& runs) {
  Json title = entry(entry(records_of(runs.first), "run"), "title");
  if (!title.is_string()) title = runs.first.name;
  const bool reduced = runs.first.compared.profiles.header.reduced.value();
  return fmt::format("{}: {} and {}{}", title.get<std::string>(), name_of(runs.first.kind),
                     name_of(runs.second.kind), reduced ? " (reduced)" : "");
}

void add_origins(Json& content, const ComparedRuns& runs) {
  content["particles"] = origin_of(runs.first);
  content["continuum"] = origin_of(runs.second);
  content["floor"] =
      runs.floor ? Json{{"name", runs.floor->name}, {"kind", name_of(runs.floor->kind)}} : Json();
  content["provenance"] = provenance();
  std::vector<std::string> edits = runs.first.accepted;
  edits.insert(edits.end(), runs.second.accepted.begin(), runs.second.accepted.end());
  for (const auto* another : {&runs.floor, &runs.beside})
    if (*another) edits.insert(edits.end(), (*another)->accepted.begin(), (*another)->accepted.end());
  add_accepted_edits(content["provenance"], edits);
}

std::string unsteady_text(const Json& content) {
  std::string text;
  for (const char* side : {"particles", "continuum"})
    for (const Json& reason : content[side].value("unsteady", Json::array()))
      text += fmt::format("  not steady: {}: {}\n", content[side]["name"].get<std::string>(),
                          reason.get<std::string>());
  return text;
}

}  // namespace drumlin::apps
