#pragma once
// The hard cases of the continuum, run through the public solver. One table, used by `drumlin hardcases`
// (through drumlin-flow) and by tests/continuum. FemRuntime has to live; all ranks run a case together.
#include <vector>

#include "coupling/exchange/hard_case.hpp"

namespace drumlin {

/// All cases in the order in which they are shown.
const std::vector<HardCase>& flow_hard_cases();

}  // namespace drumlin
