#pragma once
// The kernel of coarse graining, of both sides: the product of two cubic B-splines
// (docs/theory/coarse-graining.md says why).
#include <algorithm>
#include <cmath>

namespace drumlin {

/// As headers of files name it.
inline constexpr const char* spline_kernel_name = "product of cubic B-splines";

/// Cubic B-spline with knots one apart, integral 1, zero for |u| >= 2; variance 1/3. It is the density of the
/// sum of four numbers drawn evenly from [-1/2, 1/2].
inline double spline(double u) {
  const double t = std::max(2 - std::abs(u), 0.0), s = std::max(1 - std::abs(u), 0.0);
  return (t * t * t - 4 * s * s * s) / 6;
}

inline double spline_slope(double u) {
  const double t = std::max(2 - std::abs(u), 0.0), s = std::max(1 - std::abs(u), 0.0);
  const double downhill = (4 * s * s - t * t) / 2;  // on the side u > 0
  return u < 0 ? -downhill : downhill;
}

/// Integral from minus infinity to u.
inline double spline_integral(double u) {
  const double t = std::max(2 - std::abs(u), 0.0), s = std::max(1 - std::abs(u), 0.0);
  const double tail = (t * t * t * t - 4 * s * s * s * s) / 24;
  return u < 0 ? tail : 1 - tail;
}

/// Share of the kernel around (x, z) that lies in a circle of radius `radius` about the origin. `width`:
/// distance of the knots. Error below 1e-4.
double kernel_share_in_circle(double x, double z, double width, double radius);

}  // namespace drumlin
