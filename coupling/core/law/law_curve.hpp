#pragma once
// A law as points of a curve, for figures: they evaluate no law themselves.
#include <vector>

#include "coupling/core/law/friction_law.hpp"

namespace drumlin {

/// mu at 41 values of I, evenly in ln I from I_min to I_max.
struct LawCurve {
  std::vector<double> I, mu;
};

/// Needs 0 < I_min < I_max.
LawCurve law_curve(const FrictionLaw& law, double I_min, double I_max);

}  // namespace drumlin
