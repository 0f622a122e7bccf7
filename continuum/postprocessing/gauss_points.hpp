#pragma once
// Gauss's rule of four points on [0, 1]: how layers are averaged across.
#include <array>

namespace drumlin::continuum {

struct GaussPoint {
  double place;   // in [0, 1]
  double weight;  // sums to 1
};
inline constexpr std::array<GaussPoint, 4> gauss = {{{0.0694318442029737, 0.1739274225687269},
                                                     {0.3300094782075719, 0.3260725774312731},
                                                     {0.6699905217924281, 0.3260725774312731},
                                                     {0.9305681557970263, 0.1739274225687269}}};

}  // namespace drumlin::continuum
