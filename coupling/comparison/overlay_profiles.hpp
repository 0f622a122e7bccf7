#pragma once
// Overlays of a comparison as profiles: NAME_particles with its interval and NAME_continuum, z of the first
// side.
#include "coupling/comparison/comparison.hpp"

namespace drumlin::coupling {

/// Both sides of every field that both have.
ProfileSet compared_columns(const std::vector<FieldComparison>& fields, bool reduced);

/// The centre: the compared fields, and every other column that both sides have.
ProfileSet centre_overlay(const ComparedSide& first, const ComparedSide& second,
                          const Comparison& comparison);

/// One slice, with its position and H in the header.
ProfileSet slice_overlay(const SliceComparison& slice, bool reduced);

}  // namespace drumlin::coupling
