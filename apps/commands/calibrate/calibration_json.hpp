#pragma once
// The record of a calibration (docs/formats/rheology.md).
#include <nlohmann/json_fwd.hpp>

#include "apps/commands/calibrate/fitting.hpp"

namespace drumlin::apps {

/// "drumlin-calibration-1": points, forms, bands, scores, range of validity.
nlohmann::ordered_json calibration_json(const Calibration& calibration);

}  // namespace drumlin::apps
