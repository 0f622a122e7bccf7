#pragma once
// The sections of the page, each a piece of HTML with its heading.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/support/report_page.hpp"

namespace drumlin::apps::report {

using Json = nlohmann::ordered_json;

/// What was compared, how many targets were met, the largest miss and what it means, costs: plain sentences.
std::string verdict(const Json& comparison);

std::string targets_table(const Json& comparison);
std::string scalars_table(const Json& comparison);
std::string paper_section(const Json& comparison);

/// Errors per field and zone: at the centre, over the maps, and folded away those of the slices.
std::string errors_section(const Json& comparison);

/// Seconds of both sides and their ratio, with the diagrams of accuracy over cost and of what each effect
/// costs that are among the figures.
std::string cost_section(const Json& comparison, const std::vector<ReportFigure>& figures);

/// Settings, headers, records and revisions of both sides, folded away.
std::string origin_section(const Json& comparison);

/// The figures of one section with their captions; nothing without any.
std::string figures_of(const std::vector<ReportFigure>& figures, ReportSection section);

}  // namespace drumlin::apps::report
