#pragma once
// The scalars of both sides, read at one place with one definition.
#include <vector>

#include "coupling/comparison/comparison.hpp"

namespace drumlin::coupling {

/// What a side says of a scalar; without a value if it says nothing.
Scalar said(const ComparedSide& side, const std::string& name);

/// `registered`: the second side's profile on the first one's axes, `offset` what it was moved by. A side
/// that was not moved keeps its own words.
std::vector<ScalarPair> scalar_pairs(const ComparedSide& particles, const ComparedSide& continuum,
                                     const ProfileSet& registered, double offset);

}  // namespace drumlin::coupling
