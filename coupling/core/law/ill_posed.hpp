#pragma once
// Intervals of the inertial number in which a law is ill-posed in simple shear, before anything is solved
// with it.
#include <vector>

#include "coupling/core/law/friction_law.hpp"
#include "coupling/core/law/stress_ratio.hpp"

namespace drumlin {

/// Interval of inertial numbers, both ends within the interval that was searched.
struct InertialRange {
  double from = 0;
  double to = 0;
};

/// Intervals of I in [I_min, I_max] where the law makes the equations ill-posed (well_posedness_margin() < 0)
/// in simple shear; `k` null: no k in the law. Found on a grid of 1 % in I, their ends to 1e-6 of themselves:
/// an interval narrower than the grid may be missed. None of a law whose mu does not follow from I alone: the
/// flow states its margin at each point.
std::vector<InertialRange> ill_posed_intervals(const FrictionLaw& law, const StressRatioLaw* k,
                                               double I_min = 1e-6, double I_max = 1);
/// With the k of the law, if it has one.
std::vector<InertialRange> ill_posed_intervals(const RheologyFit& law);

}  // namespace drumlin
