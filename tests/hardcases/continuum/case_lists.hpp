#pragma once
// The cases of the continuum by subject; flow_hard_cases() joins them.
#include <vector>

#include "tests/hardcases/hard_case.hpp"

namespace drumlin {

std::vector<HardCase> limit_flow_cases();  ///< I -> 0, p -> 0
std::vector<HardCase> law_flow_cases();    ///< laws that are ill-posed or make no sense
std::vector<HardCase> drum_flow_cases();   ///< stiff, fast, coarse and impossible drums

}  // namespace drumlin
