#pragma once
// A law over I as JSON.
#include "coupling/calibration/calibrated_law.hpp"
#include "coupling/core/documents/described.hpp"

namespace drumlin::coupling {
DRUMLIN_DESCRIBED(SampledLaw, I, value, low, high)
DRUMLIN_DESCRIBED(FrictionBand, low, high)
}  // namespace drumlin::coupling
