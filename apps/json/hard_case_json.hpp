#pragma once
// A hard case and its result as JSON: rows of hardcases.json, and what drumlin-flow hands to drumlin.
#include <nlohmann/json_fwd.hpp>

#include "tests/hardcases/hard_case.hpp"

namespace drumlin::apps {

nlohmann::ordered_json to_json(const HardCase& hard, const HardResult& result);

/// The other way; the case has nothing to run.
struct HardRow {
  HardCase hard;
  HardResult result;
};
HardRow hard_row(const nlohmann::ordered_json& json);

}  // namespace drumlin::apps
