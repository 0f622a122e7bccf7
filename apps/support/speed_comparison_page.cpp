#include "apps/support/speed_comparison_page.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/support/html.hpp"
#include "apps/support/report_page.hpp"
#include "apps/support/speed_comparison_json.hpp"
#include "coupling/exchange/text_file.hpp"

namespace drumlin::apps {

using Json = nlohmann::ordered_json;

namespace {

std::string shown(const Json& value) {
  if (value.is_object()) {
    const Json half = value.value("ci99", value.value("half_width", Json()));
    return shown(value.value("value", Json())) +
           (half.is_number() ? fmt::format(" &plusmn; {:.2g}", half.get<double>()) : "");
  }
  return value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : std::string("&ndash;");
}

/// Predictions count, not what was fitted.
std::string verdict_section(const Json& content) {
  int met = 0, asked = 0;
  std::string role = "predicted";
  const auto count = [&] {
    met = asked = 0;
    for (const Json& speed : content["speeds"])
      if (speed["role"] == role) {
        met += speed["verdict"]["met"].get<int>();
        asked += speed["verdict"]["met"].get<int>() + speed["verdict"]["missed"].get<int>();
      }
  };
  count();
  std::string title = "At speeds that it was not calibrated on the continuum meets {} of {} targets";
  if (asked == 0) {
    role = "unknown";
    title = "The continuum meets {} of {} targets; which speed it was calibrated on is not known";
    count();
  }
  std::string items;
  for (const std::string& line : verdict_lines(content)) items += "<li>" + escaped(line) + "</li>";
  return fmt::format("<div class=\"verdict {}\"><p><b>", met == asked && asked > 0 ? "good" : "bad") +
         fmt::format(fmt::runtime(title), met, asked) + ".</b></p><ul>" + items + "</ul></div>\n";
}

std::string scalar_rows(const Json& content, const std::string& name) {
  std::string rows;
  for (const Json& speed : content["speeds"]) {
    const Json& sides = speed["scalars"][name];
    std::string verdict = "<td></td>";
    for (const Json& target : speed["targets"])
      if (target["quantity"] == name && !target.contains("zone"))
        verdict = fmt::format("<td class=\"{}\">{} {}{}</td>", target["outcome"].get<std::string>(),
                              shown(target["value"]), escaped(target["measure"].get<std::string>()),
                              target["outcome"] == "missed" && target.value("inside_interval", false)
                                  ? ", inside the interval"
                                  : "");
    rows += fmt::format("<tr><td>{:.3g} rpm, {}</td><td>{}</td><td>{}</td><td>{}</td>{}</tr>\n",
                        speed["rotation_rpm"].get<double>(), speed["role"].get<std::string>(),
                        shown(sides["paper"]), shown(sides["particles"]), shown(sides["continuum"]), verdict);
  }
  return rows;
}

std::string scalars_section(const Json& content) {
  constexpr std::pair<const char*, const char*> quantities[] = {
      {"theta_deg", "Slope of the surface &theta; (deg)"},
      {"H", "Depth of the flowing layer H (d)"},
      {"lambda", "Decay length below it &lambda; (d)"},
      {"shear_rate", "Shear rate of the flowing layer"},
      {"Q", "Flow rate Q"},
      {"I_th", "Inertial number at the interface"}};
  std::string text = "<h2>Speed by speed</h2>\n";
  for (const auto& [name, words] : quantities)
    text += fmt::format(
                "<h3>{}</h3><table><tr><th></th><th>paper</th><th>particles (99 "
                "%)</th><th>continuum</th><th>continuum "
                "against particles</th></tr>\n",
                words) +
            scalar_rows(content, name) + "</table>\n";
  return text;
}

std::string errors_section(const Json& content) {
  std::string head = "<tr><th>error</th><th>limit</th>", rows;
  const Json* first = nullptr;
  for (const Json& speed : content["speeds"]) {
    if (speed["targets"].empty()) continue;
    if (first == nullptr) first = &speed;
    head += fmt::format("<th>{:.3g} rpm</th>", speed["rotation_rpm"].get<double>());
  }
  if (first == nullptr) return "<p>No speed has both sides.</p>\n";
  for (std::size_t t = 0; t < (*first)["targets"].size(); ++t) {
    const Json& target = (*first)["targets"][t];
    rows += fmt::format("<tr><td>{}{}</td><td>{} {}</td>", escaped(target["quantity"].get<std::string>()),
                        target.contains("zone") ? ", " + target["zone"].get<std::string>() : "",
                        shown(target["limit"]), escaped(target["measure"].get<std::string>()));
    for (const Json& speed : content["speeds"])
      if (!speed["targets"].empty())
        rows += fmt::format("<td class=\"{}\">{}</td>", speed["targets"][t]["outcome"].get<std::string>(),
                            shown(speed["targets"][t]["value"]));
    rows += "</tr>\n";
  }
  return "<h2>Errors against their limits</h2>\n<table>" + head + "</tr>\n" + rows +
         "</table>\n<p class=\"note\">Green: met, red: missed. Fields: mean over the runs of a speed, each "
         "layer at the "
         "same place of the drum. Scalars: against the mean of the runs.</p>\n";
}

std::string laws_section(const Json& content) {
  std::string rows;
  for (const auto& [name, law] : content["laws"].items()) {
    rows += fmt::format("<tr><td>{}</td><td class=\"left\">{}</td>", escaped(name), escaped(law["formula"]));
    for (const char* side : {"paper", "particles", "continuum"}) {
      std::string coefficients;
      const Json of_side = law.value(side, Json::object());
      for (const auto& [coefficient, value] : of_side.items())
        coefficients += (coefficients.empty() ? "" : ", ") + escaped(coefficient) + " = " + shown(value);
      rows += "<td class=\"left\">" + (coefficients.empty() ? "&ndash;" : coefficients) + "</td>";
    }
    rows += "</tr>\n";
  }
  return "<h2>Laws over the speed of rotation</h2>\n<table><tr><th>law</th><th "
         "class=\"left\">formula</th><th "
         "class=\"left\">paper</th><th class=\"left\">particles (99 %)</th><th class=\"left\">continuum "
         "(scatter, 99 "
         "%)</th></tr>\n" +
         rows + "</table>\n";
}

std::string costs_section(const Json& content) {
  std::string rows;
  for (const Json& speed : content["speeds"]) {
    const Json& seconds = speed["seconds"];
    rows += fmt::format("<tr><td>{:.3g} rpm</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                        speed["rotation_rpm"].get<double>(), shown(seconds["particles"]),
                        shown(seconds["continuum"]), shown(seconds["ratio"]),
                        escaped(seconds["start"].get<std::string>()));
  }
  return "<h2>What both cost</h2>\n<table><tr><th></th><th>particles, processor s</th><th>continuum, "
         "processor "
         "s</th><th>ratio</th><th>continuum started</th></tr>\n" +
         rows + "</table>\n";
}

std::string figure(const std::filesystem::path& png, const std::string& caption) {
  return fmt::format(
      "<figure><img alt=\"\" src=\"data:image/png;base64,{}\"><figcaption>{}</figcaption></figure>\n",
      base64(file_text(png)), caption);
}

}  // namespace

std::string speed_comparison_page(const Json& content, const std::filesystem::path& folder) {
  std::string runs;
  for (const Json& run : content["fitted_on"]) runs += (runs.empty() ? "" : ", ") + run.get<std::string>();
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>Particles and continuum over the speed of "
      "rotation</title><style>{}"
      "</style></head>\n<body>\n<h1>Particles and continuum over the speed of rotation</h1>\n<p "
      "class=\"note\">A "
      "drum half filled with discs turns at several speeds. Each speed was computed twice: disc by disc, and "
      "as a "
      "continuum with one friction law, read off the discs of {} and used unchanged at all speeds. Units: "
      "lengths in "
      "mean diameters d, times in &radic;(d/g), stresses in &rho;<sub>0</sub>gd; intervals of 99 %. Both "
      "sides are "
      "read at the same place of the drum, counted from its axis.</p>\n",
      page_style(), escaped(runs));
  if (content["reduced"].get<bool>())
    page +=
        "<p class=\"reduced\">reduced: small drums and short runs, made to show that the chain works; their "
        "numbers are no results.</p>\n";
  page += verdict_section(content);
  std::string warnings;
  for (const Json& warning : content["warnings"])
    warnings += "<li>" + escaped(warning.get<std::string>()) + "</li>";
  if (!warnings.empty()) page += "<div class=\"reduced\">Warnings<ul>" + warnings + "</ul></div>\n";
  page +=
      figure(folder / "speeds.png",
             "Slope over speed, depth of the flowing layer and decay length over the flow rate. Crosses: the "
             "paper; "
             "dots: particles with 99 % intervals; squares: continuum, filled where its law was calibrated, "
             "open "
             "where it predicts. Lines: laws of the paper, and the same laws fitted to each side.") +
      figure(folder / "rates.png", "Shear rate of the flowing layer and inertial number at the interface.") +
      figure(folder / "errors.png", "Each error over its limit; below 1 it is met.") +
      scalars_section(content) + errors_section(content) + laws_section(content) + costs_section(content);
  page += "<h2>Law and effects</h2>\n<pre>" + escaped(content["law"].dump()) +
          "\neffects: " + escaped(content["effects"].get<std::string>()) +
          "</pre>\n<h2>Provenance</h2>\n<pre>" + escaped(content["provenance"].dump(1)) + "</pre>\n";
  return page + "</body></html>\n";
}

}  // namespace drumlin::apps
