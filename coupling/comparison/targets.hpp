#pragma once
// Accuracy that the continuum is to reach against the particles, at x = 0 below z = -3 d.
#include <vector>

#include "coupling/comparison/comparison.hpp"

namespace drumlin::coupling {

/// Judges each target; one whose numbers are missing on a side, or whose zone holds layers that the continuum
/// leaves undefined, is never met. The noise floor, where it judges, is the particles' 99 % interval by the
/// measure of the target: of a zone the root mean square of those of its layers.
std::vector<Target> judged_targets(const std::vector<FieldComparison>& fields,
                                   const std::vector<ScalarPair>& scalars);

/// Takes the errors of another run of the particles, `floor`, for the noise floor where they are larger, in
/// the targets that it judges.
void judge_by_floor(std::vector<Target>& targets, const std::vector<Target>& floor);

}  // namespace drumlin::coupling
