#include "apps/support/speed_comparison_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/support/comparison_json.hpp"
#include "apps/support/enum_name.hpp"
#include "apps/support/json_file.hpp"
#include "coupling/documents/json_numbers.hpp"

namespace drumlin::apps {

using Json = nlohmann::ordered_json;

namespace {

Json number(double value) { return number_or_null(value); }

/// The target, and of a scalar whether the particles' interval covers the difference.
Json json_of(const coupling::Target& target, const coupling::ComparedSpeed& speed) {
  Json json = to_json(target);
  if (target.zone.empty())
    for (const coupling::SpeedScalar& scalar : speed.scalars)
      if (scalar.particles.name == target.quantity && scalar.particles.ci99 && std::isfinite(target.value))
        json["inside_interval"] =
            std::abs(scalar.continuum - scalar.particles.value) <= *scalar.particles.ci99;
  return json;
}

Json json_of(const coupling::ComparedSpeed& speed) {
  Json scalars = Json::object(), targets = Json::array();
  for (const coupling::SpeedScalar& scalar : speed.scalars) {
    Json paper = number(scalar.paper.value);
    if (scalar.paper.ci99) paper = {{"value", paper}, {"half_width", *scalar.paper.ci99}};
    scalars[scalar.particles.name] = {
        {"paper", paper},
        {"particles", to_json(scalar.particles)},
        {"continuum", std::isfinite(scalar.continuum_ci99)
                          ? Json{{"value", number(scalar.continuum)}, {"ci99", scalar.continuum_ci99}}
                          : number(scalar.continuum)}};
  }
  for (const coupling::Target& target : speed.targets) targets.push_back(json_of(target, speed));
  return {{"rotation_rpm", speed.rotation_rpm},
          {"role", name_of(speed.role)},
          {"particles", speed.particles},
          {"continuum", speed.continuum.empty() ? Json() : Json(speed.continuum)},
          {"scalars", scalars},
          {"verdict", counts_of(speed.targets)},
          {"targets", targets},
          {"seconds",
           {{"particles", number(speed.particle_seconds)},
            {"continuum", number(speed.continuum_seconds)},
            {"ratio", number(speed.particle_seconds / speed.continuum_seconds)},
            {"start", speed.start}}}};
}

void add_laws(Json& laws, const char* side, const std::vector<coupling::SpeedLaw>& of_side) {
  for (const coupling::SpeedLaw& law : of_side) {
    laws[law.name]["formula"] = law.formula;
    Json coefficients = Json::object();
    for (const auto& c : law.coefficients)
      coefficients[c.name] = {{"value", number(c.value)}, {"ci99", number(c.ci99)}};
    laws[law.name][side] = coefficients;
  }
}

/// Met and missed targets over all speeds of one role.
Json verdict_of(const std::vector<coupling::ComparedSpeed>& speeds, coupling::SpeedRole role) {
  std::vector<coupling::Target> targets;
  for (const coupling::ComparedSpeed& speed : speeds)
    if (speed.role == role) targets.insert(targets.end(), speed.targets.begin(), speed.targets.end());
  Json verdict{{"role", name_of(role)}};
  verdict.update(counts_of(targets));
  return verdict;
}

/// Predictions count, not what was fitted; where no speed is known to be one, those of unknown role.
Json verdict_of(const std::vector<coupling::ComparedSpeed>& speeds) {
  const Json predicted = verdict_of(speeds, coupling::SpeedRole::predicted);
  const bool any = predicted["met"].get<int>() + predicted["missed"].get<int>() > 0;
  return any ? predicted : verdict_of(speeds, coupling::SpeedRole::unknown);
}

std::string shown(const Json& value) {
  if (value.is_object()) {
    const Json half = value.value("ci99", value.value("half_width", Json()));
    return shown(value.value("value", Json())) +
           (half.is_number() ? fmt::format(" +- {:.2g}", half.get<double>()) : "");
  }
  return value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : std::string("-");
}

/// "0.041", "**0.21**" where it is missed, with a star where the particles' own interval covers the miss.
std::string target_cell(const Json& target) {
  const std::string text =
      target["value"].is_number() ? fmt::format("{:.3f}", target["value"].get<double>()) : "-";
  if (target["outcome"] != "missed") return text;
  return "**" + text + "**" + (target.value("inside_interval", false) ? " (inside the interval)" : "");
}

std::string scalars_table(const Json& content) {
  std::string text =
      "| rpm | | theta (deg): paper | particles | continuum | H: paper | particles | continuum | lambda: "
      "paper | "
      "particles | continuum | shear rate: particles | continuum | I_th: particles | continuum | seconds: "
      "particles "
      "| continuum |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Json& speed : content["speeds"]) {
    text +=
        fmt::format("| {:.3g} | {} |", speed["rotation_rpm"].get<double>(), speed["role"].get<std::string>());
    for (const char* name : {"theta_deg", "H", "lambda"})
      for (const char* side : {"paper", "particles", "continuum"})
        text += " " + shown(speed["scalars"][name][side]) + " |";
    for (const char* name : {"shear_rate", "I_th"})
      for (const char* side : {"particles", "continuum"})
        text += " " + shown(speed["scalars"][name][side]) + " |";
    text +=
        " " + shown(speed["seconds"]["particles"]) + " | " + shown(speed["seconds"]["continuum"]) + " |\n";
  }
  return text;
}

std::string targets_table(const Json& content) {
  std::string head = "| target | limit |", line = "|---|---|";
  const Json* first = nullptr;
  for (const Json& speed : content["speeds"]) {
    if (speed["targets"].empty()) continue;
    if (first == nullptr) first = &speed;
    head += fmt::format(" {:.3g} rpm, {} |", speed["rotation_rpm"].get<double>(),
                        speed["role"].get<std::string>());
    line += "---|";
  }
  if (first == nullptr) return "";
  std::string rows;
  for (std::size_t t = 0; t < (*first)["targets"].size(); ++t) {
    const Json& target = (*first)["targets"][t];
    rows += fmt::format("| {}{} | {:g} {} |", target["quantity"].get<std::string>(),
                        target.contains("zone") ? ", " + target["zone"].get<std::string>() : "",
                        target["limit"].get<double>(), target["measure"].get<std::string>());
    for (const Json& speed : content["speeds"])
      if (!speed["targets"].empty()) rows += " " + target_cell(speed["targets"][t]) + " |";
    rows += "\n";
  }
  return head + "\n" + line + "\n" + rows;
}

}  // namespace

std::string name_of(coupling::SpeedRole role) {
  constexpr EnumName<coupling::SpeedRole> names[] = {{coupling::SpeedRole::calibrated, "calibrated"},
                                                     {coupling::SpeedRole::predicted, "predicted"},
                                                     {coupling::SpeedRole::unknown, "unknown"},
                                                     {coupling::SpeedRole::particles_only, "particles only"},
                                                     {coupling::SpeedRole::continuum_only, "continuum only"}};
  return enum_name(names, role);
}

void add_speed_comparison(Json& content, const coupling::SpeedComparison& comparison) {
  content["warnings"] = comparison.warnings;
  content["fitted_on"] = comparison.fitted_on;
  content["speeds"] = Json::array();
  for (const coupling::ComparedSpeed& speed : comparison.speeds) content["speeds"].push_back(json_of(speed));
  Json laws = Json::object();
  add_laws(laws, "particles", comparison.particles_laws);
  add_laws(laws, "continuum", comparison.continuum_laws);
  add_laws(laws, "paper", comparison.paper_laws);
  content["laws"] = laws;
  content["verdict"] = verdict_of(comparison.speeds);
  content["verdict_lines"] = verdict_lines(content);
}

std::vector<std::string> verdict_lines(const Json& content) {
  std::vector<std::string> lines;
  for (const Json& speed : content["speeds"]) {
    const Json& counts = speed["verdict"];
    const int met = counts["met"], missed = counts["missed"];
    if (met + missed == 0) continue;
    std::string line =
        fmt::format("{:.3g} rpm, {}: {} of {} targets met", speed["rotation_rpm"].get<double>(),
                    speed["role"].get<std::string>(), met, met + missed);
    std::string misses;
    for (const Json& target : speed["targets"])
      if (target["outcome"] == "missed")
        misses += fmt::format(
            "{}{}{} {} (limit {:g} {}{})", misses.empty() ? "; missed: " : ", ",
            target["quantity"].get<std::string>(),
            target.contains("zone") ? " " + target["zone"].get<std::string>() : "",
            target["value"].is_number() ? fmt::format("{:.2g}", target["value"].get<double>()) : "-",
            target["limit"].get<double>(), target["measure"].get<std::string>(),
            target.value("inside_interval", false) ? "; inside the particles' interval" : "");
    lines.push_back(line + misses);
  }
  return lines;
}

std::string speed_table_markdown(const Json& content) {
  return scalars_table(content) + "\nErrors of the continuum; bold: missed.\n\n" + targets_table(content);
}

}  // namespace drumlin::apps
