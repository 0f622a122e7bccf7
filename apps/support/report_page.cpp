#include "apps/support/report_page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/support/html.hpp"
#include "coupling/exchange/text_file.hpp"

namespace drumlin::apps {

using Json = nlohmann::ordered_json;

namespace {

/// What the names of the files mean to a reader.
const std::map<std::string, std::string>& words() {
  static const std::map<std::string, std::string> names{
      {"theta_deg", "slope &theta; (deg)"},
      {"Q", "flow rate Q"},
      {"H", "depth of the flowing layer H (d)"},
      {"lambda", "decay length &lambda; (d)"},
      {"shear_rate", "shear rate of the flowing layer"},
      {"I_th", "inertial number at the interface"},
      {"nu_bulk", "volume fraction of the bulk"},
      {"mu_a", "a of &mu; = a + b ln I"},
      {"mu_b", "b of &mu; = a + b ln I"},
      {"k_flowing", "k in the flowing layer"},
      {"spin_over_half_vorticity", "spin over half the vorticity"},
      {"dv_over_shear", "velocity fluctuation over shear rate"},
      {"domega_over_shear", "spin fluctuation over shear rate"},
      {"linear_layer_share", "0.4 &middot; shear rate &middot; H&sup2; / Q"},
      {"v_x", "velocity v<sub>x</sub>"},
      {"sigma_zz", "&sigma;<sub>zz</sub>"},
      {"sigma_xz", "&sigma;<sub>xz</sub>"},
      {"sigma_xx", "&sigma;<sub>xx</sub>"},
      {"log10_shear_rate", "log<sub>10</sub> of the shear rate"},
      {"stress_strain_axis_angle", "angle between the axes of stress and strain rate"}};
  return names;
}

std::string words_for(const std::string& name) {
  const auto found = words().find(name);
  return found == words().end() ? escaped(name) : found->second;
}

bool is_known(const Json& value) { return value.is_number() && std::isfinite(value.get<double>()); }

/// Four digits suffice for a reader; the JSON file has them all.
std::string shown(const Json& value) {
  return is_known(value) ? fmt::format("{:.4g}", value.get<double>()) : std::string("&ndash;");
}

std::string shown_measurement(const Json& measured) {
  if (!measured.is_object()) return shown(measured);
  std::string text = shown(measured.value("value", Json()));
  const Json interval = measured.value("ci99", Json());
  return is_known(interval) ? text + fmt::format(" &plusmn; {:.2g}", interval.get<double>()) : text;
}

double value_of(const Json& measured) {
  const Json value = measured.is_object() ? measured.value("value", Json()) : measured;
  return is_known(value) ? value.get<double>() : std::nan("");
}

std::string difference(double from, double to) {
  if (std::isnan(from) || std::isnan(to)) return "&ndash;";
  if (from == 0) return fmt::format("{:+.3g}", to - from);
  return fmt::format("{:+.3g} ({:+.1f} %)", to - from, 100 * (to - from) / std::abs(from));
}

std::string outcome_cell(const std::string& outcome) {
  return fmt::format("<td class=\"{}\">{}</td>", outcome,
                     outcome == "not_measured" ? "not measured" : outcome);
}

/// The paper sets no target: its numbers are met or not, ours are not "missed". A difference that our own
/// interval covers is said to be one.
std::string agreement_cell(const std::string& outcome, bool inside_interval = false) {
  std::string words = outcome == "met" ? "agrees" : outcome == "missed" ? "differs" : "&ndash;";
  if (outcome == "missed" && inside_interval) words += ", within its interval";
  return fmt::format("<td class=\"{}\">{}</td>", outcome, words);
}

bool covers(const Json& measurement, double value) {
  const Json interval = measurement.is_object() ? measurement.value("ci99", Json()) : Json();
  return is_known(interval) && std::abs(value_of(measurement) - value) <= interval.get<double>();
}

std::string target_name(const Json& target) {
  std::string name = words_for(target["quantity"].get<std::string>());
  if (target.contains("zone")) name += ", " + target["zone"].get<std::string>();
  return name;
}

std::string verdict(const Json& comparison) {
  const Json& counts = comparison["verdict"];
  const int met = counts["met"], missed = counts["missed"], absent = counts["not_measured"];
  std::string text = fmt::format("<div class=\"verdict {}\"><p><b>The continuum meets {} of {} targets</b>",
                                 missed == 0 && met > 0 ? "good" : "bad", met, met + missed);
  text += absent > 0 ? fmt::format("; {} could not be measured.</p>", absent) : ".</p>";
  std::string misses;
  for (const auto& target : comparison["targets"])
    if (target["outcome"] == "missed")
      misses +=
          fmt::format("<li>{}: {} where {} {} is asked</li>", target_name(target), shown(target["value"]),
                      shown(target["limit"]), escaped(target["measure"].get<std::string>()));
  if (!misses.empty()) text += "<p>Missed:</p><ul>" + misses + "</ul>";
  return text + "</div>\n";
}

std::string scalars_table(const Json& comparison) {
  std::string rows;
  for (const auto& [name, sides] : comparison["scalars"].items()) {
    const Json &particles = sides["particles"], &continuum = sides["continuum"];
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", words_for(name),
                        shown_measurement(particles), shown(continuum),
                        difference(value_of(particles), value_of(continuum)));
  }
  return "<h2>Scalars</h2>\n<table><tr><th>quantity</th><th>particles (99 %)</th><th>continuum</th>"
         "<th>continuum &minus; particles</th></tr>\n" +
         rows +
         "</table>\n<p class=\"note\">Units d, &radic;(d/g), &rho;<sub>0</sub>gd; a dash marks what a side "
         "does not have. Only the law, the volume fraction, the fill and the rotation speed crossed from the "
         "particles to the continuum. 0.4 &middot; shear rate &middot; H&sup2; / Q is the share of the flow "
         "that "
         "a linear layer at &nu; = 0.8 carries: a check that the three belong together.</p>\n";
}

std::string targets_table(const Json& comparison) {
  std::string rows;
  for (const auto& target : comparison["targets"]) {
    const double value = value_of(target["value"]), limit = target["limit"];
    rows += fmt::format(
        "<tr><td>{}</td><td class=\"left\">{}</td><td>{}</td><td>{}</td><td>{}</td>{}<td "
        "class=\"left\">{}</td></tr>\n",
        target_name(target), escaped(target["measure"].get<std::string>()), shown(target["limit"]),
        shown(target["value"]), std::isnan(value) ? "&ndash;" : fmt::format("{:.2f}", value / limit),
        outcome_cell(target["outcome"]), escaped(target.value("remark", std::string())));
  }
  return "<h2>Targets</h2>\n<table><tr><th>quantity, zone</th><th "
         "class=\"left\">measure</th><th>limit</th><th>reached</th>"
         "<th>reached / limit</th><th>outcome</th><th></th></tr>\n" +
         rows + "</table>\n";
}

std::string errors_table(const Json& comparison) {
  std::string rows;
  for (const auto& [field, zones] : comparison["errors"].items())
    for (const auto& [zone, errors] : zones.items())
      rows += fmt::format(
          "<tr><td>{}</td><td "
          "class=\"left\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
          words_for(field), zone, shown(errors["rel_l2"]), shown(errors["rms"]), shown(errors["max"]),
          shown(errors["inside_band"]), shown(errors["layers"]));
  std::string limits;
  for (const auto& [zone, range] : comparison["zones"].items())
    limits += fmt::format("{}{} {} &le; z &le; {}", limits.empty() ? "" : "; ", zone, shown(range["from"]),
                          shown(range["to"]));
  return "<h2>Errors of the profiles at x = 0</h2>\n<table><tr><th>field</th><th class=\"left\">zone</th>"
         "<th>relative L&sup2;</th><th>rms</th><th>largest</th><th>inside the 99 % "
         "band</th><th>layers</th></tr>\n" +
         rows + "</table>\n<p class=\"note\">Zones: " + limits +
         ". Relative to the zone's own norm. With this law a stress error of 1 % is a velocity error of "
         "about 30 %: velocity is "
         "the hard field, stress the easy one.</p>\n";
}

std::string paper_section(const Json& comparison) {
  const Json& paper = comparison["paper"];
  std::string text = "<h2>Against the paper</h2>\n";
  if (paper.is_null())
    return text + "<p>This drum is none of the paper's six; its numbers do not apply.</p>\n";
  std::string rows;
  for (const auto& row : paper["rows"]) {
    const double published = row["paper"];
    const auto half_width = row.contains("paper_half_width")
                                ? fmt::format(" &plusmn; {:.2g}", row["paper_half_width"].get<double>())
                                : "";
    rows += fmt::format(
        "<tr><td>{}</td><td>{}{}</td><td>{}</td><td>{}</td>{}<td>{}</td>{}<td>{}</td><td class=\"left "
        "note\">{}</td></tr>\n",
        words_for(row["name"]), shown(row["paper"]), half_width, shown_measurement(row["particles"]),
        difference(published, value_of(row["particles"])),
        agreement_cell(row["particles_outcome"], covers(row["particles"], published)),
        shown(row["continuum"]), agreement_cell(row["continuum_outcome"]), shown(row["accepted_difference"]),
        escaped(row["source"].get<std::string>()));
  }
  return text + fmt::format("<p>Centre of the drum at {} rpm.</p>\n", shown(paper["rotation_rpm"])) +
         "<table><tr><th>quantity</th><th>paper</th><th>particles (99 %)</th><th>particles &minus; "
         "paper</th><th></th>"
         "<th>continuum</th><th></th><th>accepted</th><th class=\"left\">where</th></tr>\n" +
         rows +
         "</table>\n<p class=\"note\">&ldquo;accepted&rdquo; is the largest difference that counts as "
         "agreement: the paper's own "
         "uncertainty where it states one, else the project's choice.</p>\n";
}

std::string costs_section(const Json& comparison) {
  std::string rows;
  for (const auto& [name, seconds] : comparison["costs"].items())
    rows += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped(name), shown(seconds));
  return "<h2>Costs</h2>\n<table><tr><th>what</th><th>seconds</th></tr>\n" + rows + "</table>\n";
}

std::string origin_section(const Json& comparison) {
  return "<h2>Settings and origin</h2>\n<h3>Particles</h3><pre>" + escaped(comparison["particles"].dump(2)) +
         "</pre>\n<h3>Continuum</h3><pre>" + escaped(comparison["continuum"].dump(2)) +
         "</pre>\n<h3>This comparison</h3><pre>" +
         escaped(
             Json{{"settings", comparison["settings"]}, {"provenance", comparison["provenance"]}}.dump(2)) +
         "</pre>\n";
}

std::string figures_section(const std::vector<ReportFigure>& figures) {
  std::string text = "<h2>Profiles at x = 0</h2>\n";
  for (const auto& figure : figures)
    text += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        escaped(figure.caption), base64(file_text(figure.png)));
  return text;
}

}  // namespace

std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

std::string report_page(const Json& comparison, const std::vector<ReportFigure>& figures) {
  const std::string title = escaped(comparison["title"].get<std::string>());
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{0}</title><style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n"
      "<p class=\"note\">Particles (rigid discs, nonsmooth contact dynamics) and continuum (finite elements "
      "with the law "
      "calibrated on particles), side by side.</p>\n",
      title, page_style());
  if (comparison["reduced"].get<bool>())
    page +=
        "<p class=\"reduced\">reduced: a small drum and a short run, made to show that the chain works; its "
        "numbers are "
        "no results.</p>\n";
  page += verdict(comparison) + scalars_table(comparison) + targets_table(comparison) +
          figures_section(figures) + errors_table(comparison) + paper_section(comparison) +
          costs_section(comparison) + origin_section(comparison);
  return page + "</body></html>\n";
}

}  // namespace drumlin::apps
