#pragma once
// What turns the keys of an effect into its law: law_of(keys, LawInput).
#include <string>
#include <vector>

#include "coupling/core/basics/scales.hpp"

namespace drumlin::particles {

struct LawInput {
  const Scales& scales;                       ///< units of the simulation
  const std::vector<std::string>& materials;  ///< names, in the order of their numbers
};

}  // namespace drumlin::particles
