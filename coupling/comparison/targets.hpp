#pragma once
// Accuracy that the continuum is to reach against the particles, at x = 0 below z = -3 d.
#include <vector>

#include "coupling/comparison/comparison.hpp"

namespace drumlin::coupling {

/// Judges each target; one whose numbers are missing on a side, or whose zone holds layers that the continuum
/// leaves undefined, is never met.
std::vector<Target> judged_targets(const std::vector<FieldComparison>& fields,
                                   const std::vector<ScalarPair>& scalars);

}  // namespace drumlin::coupling
