#pragma once
// What a calibration found of the length over which flow spreads, for its record and in words
// (docs/formats/rheology.md).
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "coupling/calibration/nonlocal_fit.hpp"

namespace drumlin::apps {

/// The key "nonlocal" of "drumlin-calibration-1".
nlohmann::ordered_json nonlocal_json(const coupling::NonlocalFit& found);
/// The lines of `drumlin calibrate --nonlocal`.
std::string nonlocal_text(const coupling::NonlocalFit& found);

}  // namespace drumlin::apps
