#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/support/html.hpp"
#include "apps/support/report/sections.hpp"
#include "apps/support/report/words.hpp"

namespace drumlin::apps::report {

namespace {

std::string folded(const std::string& summary, const Json& content) {
  return "<details><summary>" + summary + "</summary><pre>" + escaped(content.dump(2)) + "</pre></details>\n";
}

}  // namespace

std::string cost_section(const Json& comparison, const std::vector<ReportFigure>& figures) {
  std::string rows;
  for (const auto& [name, seconds] : comparison["costs"].items())
    rows += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escaped(name), shown(seconds));
  const Json ratio = comparison.value("cost_ratio", Json::object());
  for (const auto& [name, value] : ratio.items())
    rows += fmt::format("<tr><td>first side over second, {}</td><td>{}</td></tr>\n", escaped(name),
                        is_known(value) ? shown(value) + " times" : shown(value));
  return "<h2>Costs</h2>\n<table><tr><th>what</th><th>seconds</th></tr>\n" + rows +
         "</table>\n<p class=\"note\">Wall time is what one waits, processor time what stays nearly the same "
         "on a busy machine. The measurement of a run is done once and not part of the ratio.</p>\n" +
         figures_of(figures, ReportSection::costs);
}

std::string origin_section(const Json& comparison) {
  return "<h2>Settings and origin</h2>\n<p class=\"note\">Everything that is needed to do it again: "
         "settings, "
         "revisions, machines, and the records that both programs left.</p>\n" +
         folded(side_name(comparison, "particles"), comparison["particles"]) +
         folded(side_name(comparison, "continuum"), comparison["continuum"]) +
         folded("this comparison",
                Json{{"settings", comparison["settings"]}, {"provenance", comparison["provenance"]}});
}

}  // namespace drumlin::apps::report
