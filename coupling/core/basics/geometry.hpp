#pragma once
// What flows: a drum, or across a gap.
#include "coupling/core/basics/enum_names.hpp"

namespace drumlin {

enum class Geometry { drum, plane_shear, incline, chute, annulus };
constexpr auto names_of(Geometry) { return std::array{"drum", "plane_shear", "incline", "chute", "annulus"}; }

}  // namespace drumlin
