#pragma once
// The record of a calibration (docs/formats/rheology.md).
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "coupling/calibration/calibration.hpp"
#include "coupling/core/results/measured_run.hpp"

namespace drumlin::apps {

/// "drumlin-calibration-1": points, forms, bands, scores, range of validity. `runs`: those that were read,
/// for what makes them unsteady.
nlohmann::ordered_json calibration_json(const coupling::Calibration& calibration,
                                        const std::vector<MeasuredRun>& runs);

}  // namespace drumlin::apps
