#include "apps/support/study_page.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/support/html.hpp"
#include "apps/support/json_file.hpp"
#include "apps/support/report_page.hpp"
#include "coupling/exchange/text_file.hpp"

namespace drumlin::apps {

using Json = nlohmann::ordered_json;

namespace {

std::string shown(const Json& value) {
  if (value.is_object()) {
    const Json interval = value.value("ci99", Json());
    return shown(value.value("value", Json())) +
           (interval.is_number() ? fmt::format(" &plusmn; {:.2g}", interval.get<double>()) : "");
  }
  return value.is_number() ? fmt::format("{:.4g}", value.get<double>()) : std::string("&ndash;");
}

std::string said_by_paper(const Json& row) {
  const std::string expects = row["expects"];
  if (expects != "value") return expects;
  return shown(row["paper"]) + (row.contains("paper_half_width")
                                    ? fmt::format(" &plusmn; {:.2g}", row["paper_half_width"].get<double>())
                                    : "");
}

/// The classes of the style sheet that colour a verdict.
std::string class_of(const std::string& verdict) {
  if (verdict == "agrees") return "met";
  if (verdict == "differs") return "missed";
  return verdict == "near" ? "near" : "not_measured";
}

std::string warnings_section(const Json& study) {
  if (study["warnings"].empty()) return "";
  std::string items;
  for (const Json& warning : study["warnings"])
    items += "<li>" + escaped(warning.get<std::string>()) + "</li>";
  return "<div class=\"reduced\">Warnings<ul>" + items + "</ul></div>\n";
}

std::string paper_section(const Json& study) {
  if (study["paper_table"].is_null())
    return "<p>This drum is none of the paper's six; its numbers do not apply.</p>\n";
  std::string rows;
  for (const Json& row : study["paper_table"])
    rows += fmt::format(
        "<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td class=\"{}\">{}</td><td "
        "class=\"left\">{}</td><td "
        "class=\"left note\">{}</td></tr>\n",
        escaped(row["quantity"]), row["rotation_rpm"].is_null() ? "all" : shown(row["rotation_rpm"]),
        said_by_paper(row), shown(row["ours"]), class_of(row["verdict"]), escaped(row["verdict"]),
        escaped(row["reason"]),
        escaped(row["source"].get<std::string>() +
                (row.contains("remark") ? ": " + row["remark"].get<std::string>() : "")));
  const Json& counts = study["verdict"];
  return fmt::format(
             "<div class=\"verdict\"><p><b>{} entries agree, {} are near, {} differ</b>; {} were not "
             "measured.</p></div>\n",
             counts["agrees"].get<int>(), counts["near"].get<int>(), counts["differs"].get<int>(),
             counts["not measured"].get<int>()) +
         "<table><tr><th>quantity</th><th>rpm</th><th>paper</th><th>ours (99 %)</th><th>verdict</th><th "
         "class=\"left\">why</th><th class=\"left\">where in the paper</th></tr>\n" +
         rows + "</table>\n";
}

std::string consistency_section(const Json& study) {
  constexpr const char* keys[] = {"rotation_rpm",
                                  "Q",
                                  "Q_expected",
                                  "paper_Q",
                                  "H",
                                  "paper_H",
                                  "shear_rate",
                                  "shear_rate_laboratory",
                                  "paper_shear_rate",
                                  "layer_balance",
                                  "paper_layer_balance",
                                  "H_over_sqrt_Q",
                                  "paper_H_over_sqrt_Q"};
  std::string rows;
  for (const Json& row : study["consistency"]) {
    rows += "<tr>";
    for (const char* key : keys) rows += "<td>" + shown(row[key]) + "</td>";
    rows += "</tr>\n";
  }
  return "<h2>Do the numbers belong together?</h2>\n<table><tr><th>rpm</th><th>Q</th><th>mass "
         "balance</th><th>paper</th><th>H</th><th>paper</th><th>shear rate</th><th>+ "
         "&Omega;</th><th>paper</th>"
         "<th>share</th><th>paper</th><th>H / &radic;Q</th><th>paper</th></tr>\n" +
         rows +
         "</table>\n<p class=\"note\">A linear layer at &nu; = 0.8 carries the share 0.4 &middot; shear rate "
         "&middot; H&sup2; / Q of the flow; the creep below it carries the rest. With &Omega; added the "
         "shear "
         "rate is that of the laboratory frame. The paper's shear rate is the stated one at 6 rpm, else that "
         "of "
         "its own law at its own slope.</p>\n";
}

std::string laws_section(const Json& study) {
  std::string rows;
  for (const auto& [name, law] : study["laws"].items()) {
    std::string coefficients;
    for (const auto& [coefficient, value] : law["coefficients"].items())
      coefficients += (coefficients.empty() ? "" : ", ") + escaped(coefficient) + " = " + shown(value);
    rows += fmt::format(
        "<tr><td>{}</td><td class=\"left\">{}</td><td class=\"left\">{}</td><td>{}</td><td>{}</td></tr>\n",
        escaped(name), escaped(law["formula"]), coefficients, shown(law["reduced_chi2"]), shown(law["rms"]));
  }
  return "<h2>Laws over the speed of rotation</h2>\n<table><tr><th>law</th><th "
         "class=\"left\">formula</th><th "
         "class=\"left\">coefficients (99 %)</th><th>&chi;&sup2; per degree of "
         "freedom</th><th>rms</th></tr>\n" +
         rows + "</table>\n";
}

std::string figures_section(const std::filesystem::path& folder) {
  const Json list = read_json(folder / "figures.json", "drumlin-study-figures-1");
  std::string text = "<h2>Figures, in the order of the paper</h2>\n";
  for (const Json& figure : list["figures"])
    text += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption><b>{0}</b><br>The paper: {2}"
        "<br>Here: {3}</figcaption></figure>\n",
        escaped(figure["title"]), base64(file_text(folder / figure["file"].get<std::string>())),
        escaped(figure["paper"]), escaped(figure["here"]));
  return text;
}

}  // namespace

std::string study_page(const Json& study, const std::filesystem::path& folder) {
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>The paper and the particles</title><style>{}</style></head>\n"
      "<body>\n<h1>The paper and the particles</h1>\n<p class=\"note\">M. Renouf, D. Bonamy, F. Dubois, P. "
      "Alart, "
      "&ldquo;Numerical simulation of 2D steady granular flows in rotating drum: On surface flows "
      "rheology&rdquo;, entry by entry and figure by figure. Units d, &radic;(d/g), &rho;<sub>0</sub>gd; "
      "intervals of 99 %; x points downslope.</p>\n",
      page_style());
  if (study["reduced"].get<bool>())
    page +=
        "<p class=\"reduced\">reduced: small drums and short runs, made to show that the chain works; their "
        "numbers are no results.</p>\n";
  page += warnings_section(study) + paper_section(study) + consistency_section(study) + laws_section(study) +
          figures_section(folder);
  return page + "</body></html>\n";
}

}  // namespace drumlin::apps
