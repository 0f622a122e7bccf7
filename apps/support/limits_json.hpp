#pragma once
// The limits of a study, judged: their part of study.json and their table (docs/formats/comparison-study.md).
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "coupling/study/judged_limits.hpp"

namespace drumlin::apps {

nlohmann::ordered_json to_json(const coupling::JudgedLimits& judged);

/// One line per limit with its value and noise floor at each speed, first by the axis, then by the surface.
std::string limits_markdown(const nlohmann::ordered_json& judged);

}  // namespace drumlin::apps
