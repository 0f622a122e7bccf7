#pragma once
// A law over I as JSON.
#include "apps/json/described.hpp"
#include "coupling/calibration/calibrated_law.hpp"

namespace drumlin::coupling {
DRUMLIN_DESCRIBED(SampledLaw, I, value, low, high)
}
