#include "apps/support/limits_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/support/comparison_json.hpp"
#include "coupling/documents/json_numbers.hpp"

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;
Json json_of(const coupling::LimitCell& cell) {
  Json json{{"rotation_rpm", cell.rotation_rpm},
            {"value", number_or_null(cell.value)},
            {"floor", number_or_null(cell.floor)},
            {"floor_of_other_speeds", cell.floor_of_others},
            {"limit", cell.limit},
            {"met", std::isnan(cell.value) && !cell.undefined ? Json() : Json(cell.met)}};
  if (cell.undefined) json["undefined"] = true;
  return json;
}

std::string shown(const Json& value) {
  return value.is_number() ? fmt::format("{:.3g}", value.get<double>()) : "-";
}

std::string cell_text(const Json& cell) {
  std::string text = shown(cell["value"]);
  if (cell["met"].is_boolean() && !cell["met"].get<bool>()) text = "**" + text + "**";
  if (cell["floor"].is_number())
    text +=
        fmt::format(" ({}{})", shown(cell["floor"]), cell["floor_of_other_speeds"].get<bool>() ? "*" : "");
  return text;
}

std::string limit_text(const Json& row) {
  const std::string worst =
      row.contains("must_worst") ? fmt::format(", one speed {}", shown(row["must_worst"])) : "";
  return fmt::format("{}{}; {}", shown(row["must"]), worst, shown(row["aim"]));
}

std::string table(const Json& judged, const std::string& registered) {
  std::string head = "| by the " + registered + " | must; aim |", line = "|---|---|";
  for (const Json& speed : judged["speeds_rpm"]) {
    head += fmt::format(" {:.3g} rpm |", speed.get<double>());
    line += "---|";
  }
  std::string text = head + " must | aim |\n" + line + "---|---|\n";
  for (const Json& row : judged["rows"]) {
    if (row["registered_by"] != registered) continue;
    text += fmt::format("| {}{}, {}, {} | {} |", row["quantity"].get<std::string>(),
                        row["zone"] == "" ? "" : " " + row["zone"].get<std::string>(),
                        row["where"].get<std::string>(), row["measure"].get<std::string>(), limit_text(row));
    for (const Json& cell : row["cells"]) text += " " + cell_text(cell) + " |";
    text += fmt::format(" {} | {} |\n", row["must_outcome"].get<std::string>(),
                        row["aim_outcome"].get<std::string>());
  }
  return text;
}

}  // namespace

Json to_json(const coupling::JudgedLimits& judged) {
  Json rows = Json::array();
  for (const coupling::LimitRow& row : judged.rows) {
    Json cells = Json::array();
    for (const coupling::LimitCell& cell : row.cells) cells.push_back(json_of(cell));
    Json json{{"registered_by", row.registration == coupling::Registration::axis ? "axis" : "surface"},
              {"quantity", row.limit.quantity},
              {"where", row.limit.where},
              {"zone", row.limit.zone},
              {"measure", row.limit.measure},
              {"must", row.limit.must},
              {"aim", row.limit.aim}};
    if (row.limit.must_worst) json["must_worst"] = *row.limit.must_worst;
    json["cells"] = cells;
    json["must_outcome"] = name_of(row.must);
    json["aim_outcome"] = name_of(row.aim);
    rows.push_back(json);
  }
  return {{"speeds_rpm", judged.speeds},
          {"judged_by", judged.judged_by},
          {"judged_by_calibrating_runs", judged.calibrated_by},
          {"rows", rows}};
}

std::string limits_markdown(const Json& judged) {
  std::string text =
      "Errors of the continuum; in brackets the noise floor, the same between two seeds (*: that of other "
      "speeds); "
      "bold: beyond the limit.\n\n" +
      table(judged, "axis") + "\n" + table(judged, "surface");
  if (!judged["judged_by_calibrating_runs"].empty())
    text += "\nJudged by runs that calibrated the law, since their speed has no others: " +
            judged["judged_by_calibrating_runs"].dump() + "\n";
  return text;
}

}  // namespace drumlin::apps
