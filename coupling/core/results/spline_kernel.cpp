#include "coupling/core/results/spline_kernel.hpp"

namespace drumlin {

double kernel_share_in_circle(double x, double z, double width, double radius) {
  if (std::hypot(std::abs(x) + 2 * width, std::abs(z) + 2 * width) <= radius) return 1;
  // Strips across the support: exact along z, the middle of each strip along x. The spline vanishes smoothly
  // at its ends, the chord has a root there only where the circle ends within a strip.
  constexpr int strips = 256;
  double share = 0, whole = 0;
  for (int strip = 0; strip < strips; ++strip) {
    const double u = 4 * (strip + 0.5) / strips - 2;
    const double weight = spline(u), at = x + u * width;
    whole += weight;
    const double square = radius * radius - at * at;
    if (!(square > 0)) continue;
    const double half_chord = std::sqrt(square);
    share +=
        weight * (spline_integral((half_chord - z) / width) - spline_integral((-half_chord - z) / width));
  }
  return share / whole;
}

}  // namespace drumlin
