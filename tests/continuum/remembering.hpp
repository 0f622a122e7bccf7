#pragma once
// A law with memory of the axes, as mu = 0.35 + 0.013 ln I of the small drum, and one of the amount.
#include <cmath>

#include "continuum/model/flow_problem.hpp"

namespace drumlin::testing_remembering {

inline const FrictionTable amount{{1e-6, 1}, {0.35 + 0.013 * std::log(1e-6), 0.35}};
inline const MemoryLaw law{.c = 6, .m = 0.9, .chi_deg = 25, .c_rho = 100, .mu = amount};
inline const AmountMemory swelling{
    .swelling = 0.008, .c_nu = 4, .c_psi = 16, .lag = 0.05, .creep = Creep{.slope = 0.015, .ratio = 0.05}};

}  // namespace drumlin::testing_remembering
