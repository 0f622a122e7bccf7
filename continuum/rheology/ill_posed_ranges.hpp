#pragma once
// Ranges of I in which a law is ill-posed in simple shear.
#include <vector>

#include "continuum/rheology/stress_law.hpp"
#include "coupling/law/ill_posed.hpp"

namespace drumlin::continuum {

/// ill_posed_intervals() of the friction law; none for a NewtonianLaw.
std::vector<InertialRange> ill_posed_ranges(const StressLaw& law, const StressRatioLaw* k,
                                            double I_min = 1e-6, double I_max = 1);

}  // namespace drumlin::continuum
