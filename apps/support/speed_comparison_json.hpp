#pragma once
// Writers of study.json of `drumlin compare --study` (docs/formats/comparison-study.md) and of its table.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "coupling/study/speed_comparison.hpp"

namespace drumlin::apps {

std::string name_of(
    coupling::SpeedRole role);  ///< "calibrated", "predicted", "unknown", "particles only", ...

/// Everything but format, title, reduced, law and provenance.
void add_speed_comparison(nlohmann::ordered_json& content, const coupling::SpeedComparison& comparison);

/// One line per speed with the results of all sides, one line per target with its value at each speed.
std::string speed_table_markdown(const nlohmann::ordered_json& content);

/// "predicted 4, 5 rpm: 18 of 20 targets met": the verdict in one line per role.
std::vector<std::string> verdict_lines(const nlohmann::ordered_json& content);

}  // namespace drumlin::apps
