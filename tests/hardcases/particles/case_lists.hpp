#pragma once
// The cases of the particles by subject; particle_hard_cases() joins them.
#include <vector>

#include "tests/hardcases/hard_case.hpp"

namespace drumlin {

std::vector<HardCase> impact_cases();
std::vector<HardCase> energy_cases();
std::vector<HardCase> sliding_cases();
std::vector<HardCase> static_cases();
std::vector<HardCase> overlap_cases();
std::vector<HardCase> drum_cases();
std::vector<HardCase> invariance_cases();
std::vector<HardCase> wall_cases();
std::vector<HardCase> smooth_cases();

}  // namespace drumlin
