#include "continuum/rheology/ill_posed_ranges.hpp"

#include <type_traits>

namespace drumlin::continuum {

std::vector<InertialRange> ill_posed_ranges(const StressLaw& law, const StressRatioLaw* k, double I_min,
                                            double I_max) {
  return std::visit(
      [&](const auto& chosen) -> std::vector<InertialRange> {
        if constexpr (std::is_same_v<std::decay_t<decltype(chosen)>, NewtonianLaw>)
          return {};
        else
          return ill_posed_intervals(chosen, k, I_min, I_max);
      },
      law);
}

}  // namespace drumlin::continuum
