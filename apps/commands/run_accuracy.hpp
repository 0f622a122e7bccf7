#pragma once
// The errors that `drumlin run --accuracy-seconds` tells, as JSON and as text.
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "particles/stretches/paired_stretches.hpp"

namespace drumlin::apps {

/// As accuracy.stretches of run.json (docs/formats/run.md).
nlohmann::ordered_json to_json(const particles::PairedStretches& stretches);
/// Lines for the user, from the JSON: at the end of a run and of its measurement. `cpu_seconds`: of the run.
std::string text_of_stretches(const nlohmann::ordered_json& stretches, double cpu_seconds);
/// What such stretches would take after a run of this cost: a line that names the option.
std::string price_of_stretches(double cpu_seconds, double simulated_seconds);

}  // namespace drumlin::apps
