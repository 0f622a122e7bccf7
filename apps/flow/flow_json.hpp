#pragma once
// The content of flow.json (docs/formats/flow.md).
#include <nlohmann/json_fwd.hpp>

#include "apps/flow/finished_flow.hpp"

namespace drumlin::apps {

/// Only reads what was computed: no collective call.
nlohmann::ordered_json flow_json(const FinishedFlow& flow);

/// A law with the keys of rheology.toml.
nlohmann::ordered_json law_json(const RheologyFit& fit);

}  // namespace drumlin::apps
