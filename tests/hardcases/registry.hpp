#pragma once
// The registry of hard cases: one list per simulator, in the order in which the tables show them.
#include <filesystem>
#include <vector>

#include "tests/hardcases/hard_case.hpp"

namespace drumlin {

/// The cases of the particles, run through the public engine. Library drumlin::hard_cases.
const std::vector<HardCase>& particle_hard_cases();

/// The worst pair of each shipped scene of a folder. Same library.
std::vector<HardCase> scene_cases(const std::filesystem::path& scenes);

/// The cases of the continuum, run through the public solver. FemRuntime has to live; all ranks run a case
/// together. Library drumlin::flow_hard_cases, which links deal.II.
const std::vector<HardCase>& flow_hard_cases();

}  // namespace drumlin
