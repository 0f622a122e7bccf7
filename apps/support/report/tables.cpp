#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/support/html.hpp"
#include "apps/support/report/sections.hpp"
#include "apps/support/report/words.hpp"

namespace drumlin::apps::report {

namespace {

/// The paper sets no target: its numbers are met or not, ours are not "missed". A difference that our own
/// interval covers is said to be one.
std::string agreement_cell(const std::string& outcome, bool inside_interval = false) {
  std::string text = outcome == "met" ? "agrees" : outcome == "missed" ? "differs" : "&ndash;";
  if (outcome == "missed" && inside_interval) text += ", within its interval";
  return fmt::format("<td class=\"{}\">{}</td>", escaped(outcome), text);
}

bool covers(const Json& measurement, double value) {
  const Json interval = measurement.is_object() ? measurement.value("ci99", Json()) : Json();
  return is_known(interval) && std::abs(value_of(measurement) - value) <= interval.get<double>();
}

/// "0.178 at x = 0, z = -8.4".
std::string largest(const Json& errors) {
  const Json at = errors.value("max_at", Json::object());
  const double x = value_of(at.value("x", Json())), z = value_of(at.value("z", Json()));
  std::string text = shown(errors["max"]);
  if (std::isfinite(x) && std::isfinite(z)) text += fmt::format(" at ({:.0f}, {:.1f})", x, z);
  return text;
}

/// The cells of one zone, from its name on.
std::string error_cells(const std::string& zone, const Json& found, bool relative) {
  const Json explained = found.value("explained", Json::object());
  const Json floor = found.value(relative ? "floor_rel_l2" : "floor_rms", Json());
  return fmt::format(
      "<td "
      "class=\"left\">{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>"
      "<td>{}</td><td>{}</td>",
      escaped(zone), relative ? percent_fine(found["rel_l2"]) : "&ndash;", shown(found["rms"]),
      largest(found), relative ? percent_fine(floor) : shown(floor), percent(found["inside_band"]),
      percent(found.value("inside_both_bands", Json())), percent(explained.value("calibration", Json())),
      percent(explained.value("both", Json())),
      fmt::format("{} / {} / {}", shown(found["layers"]), shown(found.value("undefined", Json())),
                  shown(found.value("noise", Json()))));
}

std::string error_rows(const Json& errors) {
  std::string rows;
  for (const auto& [field, zones] : errors.items()) {
    if (!zones.is_object()) continue;
    std::string first = fmt::format("<td rowspan=\"{}\">{}</td>", zones.size(), short_words_for(field));
    for (const auto& [zone, found] : zones.items()) {
      rows += "<tr>" + first + error_cells(zone, found, has_relative_error(field)) + "</tr>\n";
      first.clear();
    }
  }
  return rows;
}

std::string error_table(const Json& errors) {
  return "<div class=\"wide\"><table class=\"errors\"><tr><th>field</th><th "
         "class=\"left\">zone</th><th>relative "
         "L&sup2;</th><th>rms</th><th>largest, at (x, z)</th><th>noise floor</th><th>inside the 99 % "
         "band</th>"
         "<th>inside both bands</th><th>explained by the calibration</th><th>by both bands</th>"
         "<th>places / undefined / noise</th></tr>\n" +
         error_rows(errors) + "</table></div>\n";
}

std::string limits_of(const Json& zones) {
  std::string limits;
  for (const auto& [zone, range] : zones.items())
    limits += fmt::format("{}{} {} &le; z &le; {}", limits.empty() ? "" : "; ", escaped(zone),
                          shown(range["from"]), shown(range["to"]));
  return limits;
}

std::string slices_tables(const Json& comparison) {
  const Json slices = comparison.value("slices", Json());
  if (!slices.is_array())
    return "<p class=\"note\">Slices were not compared: " +
           escaped(comparison.value("slices_missing", Json("no slices")).get<std::string>()) + ".</p>\n";
  std::string text;
  for (const Json& slice : slices)
    text += fmt::format("<details><summary>Slice at x = {} d (H = {} d; {})</summary>\n{}</details>\n",
                        shown(slice["position"]), shown(slice["H"]), limits_of(slice["zones"]),
                        error_table(slice["errors"]));
  return text;
}

std::string maps_table(const Json& comparison) {
  const Json maps = comparison.value("maps", Json());
  if (!maps.is_object())
    return "<p class=\"note\">Maps were not compared: " +
           escaped(comparison.value("maps_missing", Json("no maps")).get<std::string>()) + ".</p>\n";
  return error_table(maps["errors"]);
}

}  // namespace

std::string targets_table(const Json& comparison) {
  std::string rows;
  for (const auto& target : comparison["targets"]) {
    const double value = value_of(target["value"]), limit = target["limit"];
    rows += fmt::format(
        "<tr><td>{}</td><td class=\"left\">{}</td><td>{}</td><td>{}</td><td>{}</td>{}<td>{}</td><td "
        "class=\"left\">{}</td></tr>\n",
        target_name(target), escaped(target["measure"].get<std::string>()), shown(target["limit"]),
        shown(target["value"]), std::isnan(value) ? "&ndash;" : fmt::format("{:.2f}", value / limit),
        outcome_cell(target["outcome"]), shown(target.value("floor", Json())),
        escaped(target.value("remark", std::string())));
  }
  return "<h2>Targets</h2>\n<table><tr><th>quantity, zone</th><th "
         "class=\"left\">measure</th><th>limit</th><th>reached</th>"
         "<th>reached / limit</th><th>outcome</th><th>noise floor</th><th class=\"left\">remark</th></tr>\n" +
         rows +
         "</table>\n<p class=\"note\">All at the centre of the drum, below 3 d of depth. &ldquo;noise "
         "floor&rdquo;, "
         "where another run of the same particles was given: how far that run is off. Both of its sides are "
         "noisy; "
         "a continuum that knew the mean of many runs exactly would reach about 0.7 of it, and less than "
         "that is "
         "luck.</p>\n";
}

std::string scalars_table(const Json& comparison) {
  std::string rows;
  for (const auto& [name, sides] : comparison["scalars"].items()) {
    const Json &particles = sides["particles"], &continuum = sides["continuum"];
    rows += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", words_for(name),
                        shown_measurement(particles), shown_measurement(continuum),
                        difference(value_of(particles), value_of(continuum)),
                        shown(sides.value("continuum_own", Json())));
  }
  const std::string second = side_name(comparison, "continuum");
  return fmt::format(
             "<h2>Scalars</h2>\n<table><tr><th>quantity</th><th>{0} (99 %)</th><th>{1}</th>"
             "<th>difference</th><th>{1}, from its own surface</th></tr>\n",
             side_name(comparison, "particles"), second) +
         rows +
         "</table>\n<p class=\"note\">Units d, &radic;(d/g), &rho;<sub>0</sub>gd; a dash marks what a side "
         "does not have. H, &lambda;, the shear rate and I at the interface are read off both profiles at "
         "the "
         "same places with the same definitions; the last column holds what that side says when it counts "
         "from its own surface. 0.4 &middot; shear rate &middot; H&sup2; / Q is the share of the flow that a "
         "linear layer at &nu; = 0.8 carries: a check that the three belong together.</p>\n";
}

std::string errors_section(const Json& comparison) {
  return "<h2>Errors, field by field and zone by zone</h2>\n<p class=\"note\">Every error is taken over its "
         "zone alone, relative to the zone's own norm, never to the largest value of the whole drum. Rms and "
         "largest are in the field's unit (decades, degrees where the name says so). &ldquo;inside the 99 % "
         "band&rdquo;: share of the places where the difference is smaller than the particles' interval; "
         "&ldquo;both bands&rdquo; adds what the calibration of the law leaves open; &ldquo;explained&rdquo; "
         "is the part of the squared error that lies within a band. A place is undefined where the second "
         "side has no value, and noise where an interval leaves the sign of the shear rate open: such places "
         "are left out of shear rate, I and axis angle. With a logarithmic law 1 % of stress is about 30 % "
         "of "
         "velocity: velocity is the hard field, stress the easy one.</p>\n<h3>Centre, x = 0</h3>\n" +
         error_table(comparison["errors"]) + "<p class=\"note\">Zones: " + limits_of(comparison["zones"]) +
         ".</p>\n<h3>Whole maps</h3>\n" + maps_table(comparison) +
         "<p class=\"note\">Zones of the maps: flowing where I &ge; 0.01, static elsewhere, both 3 d away "
         "from surface and wall; upstream, middle and downstream are thirds of the surface.</p>\n" +
         "<h3>Slices</h3>\n" + slices_tables(comparison);
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
        shown_measurement(row["continuum"]), agreement_cell(row["continuum_outcome"]),
        shown(row["accepted_difference"]), escaped(row["source"].get<std::string>()));
  }
  return text + fmt::format("<p>Centre of the drum at {} rpm.</p>\n", shown(paper["rotation_rpm"])) +
         "<table><tr><th>quantity</th><th>paper</th><th>" + side_name(comparison, "particles") +
         " (99 %)</th><th>difference to the paper</th><th></th><th>" + side_name(comparison, "continuum") +
         "</th><th></th><th>accepted</th><th class=\"left\">where</th></tr>\n" + rows +
         "</table>\n<p class=\"note\">&ldquo;accepted&rdquo; is the largest difference that counts as "
         "agreement: the paper's own uncertainty where it states one, else the project's choice.</p>\n";
}

}  // namespace drumlin::apps::report
