#pragma once
// Registration: which places of two runs are the same place of the drum
// (docs/decisions.md).
#include "coupling/core/results/field_map.hpp"
#include "coupling/core/results/profile_set.hpp"

namespace drumlin::coupling {

/// axis: what lies at the same height below the drum's axis, each along its own surface's axes, is compared.
/// surface: what lies at the same depth below its own side's z = 0. The two sides draw that line
/// differently (the particles where nu crosses 0.7, the continuum along the chord of its fill): at 6 rpm
/// 1.1 to 1.35 d apart.
enum class Registration { axis, surface };
constexpr auto names_of(Registration) { return std::array{"axis", "surface"}; }

/// What has to be added to z of the second side to make it z of the first: the difference of both headers'
/// axis_depth; 0 by the surface. NaN where a header has no axis.
double registration_offset(const RunHeader& first, const RunHeader& second, Registration by);

/// The same profile or map with z, axis_depth and wall_z counted from a line `offset` lower (all of them grow
/// by it). With 0 nothing changes, not by a bit.
ProfileSet moved(ProfileSet profiles, double offset);
FieldMap moved(FieldMap map, double offset);

}  // namespace drumlin::coupling
