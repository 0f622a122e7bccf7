#pragma once
// The numbers of both sides, read with one definition from one place.
#include <vector>

#include "coupling/comparison/comparison.hpp"

namespace drumlin {

/// `registered`: the second side's profile on the first one's axes, `offset` what it was moved by. A side
/// that was not moved keeps its own words.
std::vector<ScalarPair> scalar_pairs(const ComparedSide& particles, const ComparedSide& continuum,
                                     const ProfileSet& registered, double offset);

}  // namespace drumlin
