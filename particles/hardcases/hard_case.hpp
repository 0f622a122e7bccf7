#pragma once
// The hard cases of the particles, run through the public engine. One table, used by `drumlin hardcases` and
// by tests/stability.
#include <vector>

#include "coupling/exchange/hard_case.hpp"

namespace drumlin {

/// All cases in the order in which they are shown.
const std::vector<HardCase>& hard_cases();

}  // namespace drumlin
