#pragma once
// comparison.json (docs/formats/comparison.md) from a comparison.
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "coupling/comparison/comparison.hpp"
#include "coupling/comparison/paper_table.hpp"

namespace drumlin::apps {

std::string name_of(Target::Outcome outcome);  ///< "met", "missed", "not_measured"

/// Keys verdict, zones, errors, scalars and targets.
void add_comparison(nlohmann::ordered_json& content, const Comparison& comparison);

/// Key paper: the speed and one row per number; null when the drum is none of the paper's.
void add_paper(nlohmann::ordered_json& content, std::optional<double> rotation_rpm,
               const std::vector<PaperRow>& rows);

}  // namespace drumlin::apps
