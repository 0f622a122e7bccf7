#include "apps/support/report_page.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/support/html.hpp"
#include "apps/support/report/sections.hpp"
#include "apps/support/report/words.hpp"

namespace drumlin::apps {

namespace {

using Json = nlohmann::ordered_json;

/// For somebody who has never seen the project.
constexpr const char* introduction =
    "<p class=\"note\">A drum, half full of rigid discs, turns slowly; a layer of them flows down its "
    "surface "
    "over material that creeps. It was computed grain by grain (nonsmooth contact dynamics) and as a fluid "
    "with a friction law measured on such grains (finite elements). This page sets two such runs side by "
    "side. x points down the surface, z out of it; lengths are in grain diameters d, times in "
    "&radic;(d/g), stresses in &rho;<sub>0</sub>gd.</p>\n";

std::string with_heading(const std::string& heading, const std::string& figures) {
  return figures.empty() ? std::string() : "<h2>" + heading + "</h2>\n" + figures;
}

}  // namespace

std::string report_page(const Json& comparison, const std::vector<ReportFigure>& figures) {
  using namespace report;
  const std::string title = escaped(comparison["title"].get<std::string>());
  std::string page = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\">\n<title>{0}</title><style>{1}</style></head>\n<body>\n<h1>{0}</h1>\n",
      title, page_style());
  page += introduction;
  if (comparison["reduced"].get<bool>())
    page +=
        "<p class=\"reduced\">reduced: a small drum and a short run, made to show that the chain works; its "
        "numbers are no results.</p>\n";
  page += verdict(comparison) + targets_table(comparison) +
          with_heading("Side by side over the drum", figures_of(figures, ReportSection::maps)) +
          with_heading("Profiles at x = 0", figures_of(figures, ReportSection::centre)) +
          scalars_table(comparison) + paper_section(comparison) +
          with_heading("Slices along the surface", figures_of(figures, ReportSection::slices)) +
          errors_section(comparison) + cost_section(comparison, figures) + origin_section(comparison);
  return page + "</body></html>\n";
}

}  // namespace drumlin::apps
