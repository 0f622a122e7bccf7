#pragma once
// What a calibration found of the memory of the axes, for its record (docs/formats/rheology.md).
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "coupling/calibration/memory_calibration.hpp"

namespace drumlin::apps {

/// The key "memory" of "drumlin-calibration-1". `runs`: those of the fit, for their points.
nlohmann::ordered_json memory_json(const coupling::MemoryCalibration& found,
                                   const std::vector<coupling::RunEvidence>& runs);

}  // namespace drumlin::apps
