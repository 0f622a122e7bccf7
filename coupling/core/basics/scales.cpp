#include "coupling/core/basics/scales.hpp"

#include <cmath>

namespace drumlin {

Scales scales_of(double mean_diameter_m, double gravity_m_s2, double density_kg_m3) {
  constexpr double standard_gravity_m_s2 = 9.81;
  const double gravity = gravity_m_s2 > 0 ? gravity_m_s2 : standard_gravity_m_s2;
  return {mean_diameter_m, std::sqrt(mean_diameter_m / gravity), density_kg_m3};
}

}  // namespace drumlin
