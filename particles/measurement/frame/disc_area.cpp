#include "particles/measurement/frame/disc_area.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace drumlin::particles {

double disc_area_left_of(double radius, double a) {
  if (a <= -radius) return 0;
  if (a >= radius) return std::numbers::pi * radius * radius;
  const double chord = std::sqrt(std::max(0.0, radius * radius - a * a));
  return radius * radius * (std::numbers::pi / 2 + std::asin(a / radius)) + a * chord;
}

double disc_area_in_quadrant(double radius, double a, double b) {
  const double left = disc_area_left_of(radius, a);
  const double below = disc_area_left_of(radius, b);
  const double disc = std::numbers::pi * radius * radius;
  // A corner outside the disc: the two cut-off caps do not meet, or one of them is all there is.
  if (a * a + b * b >= radius * radius) {
    if (a < 0 && b < 0) return 0;
    if (a < 0) return left;
    if (b < 0) return below;
    return left + below - disc;
  }
  // Inside: d(area)/da = b + sqrt(r^2 - a^2), the same with a and b exchanged, and a quarter disc at a = b =
  // 0.
  return (left + below) / 2 + a * b - disc / 4;
}

double sphere_volume_left_of(double radius, double a) {
  const double height = std::clamp(a + radius, 0.0, 2 * radius);  // of the cap
  return std::numbers::pi * height * height * (radius - height / 3);
}

double disc_area_in(double x, double z, double radius, const Rectangle& rectangle) {
  const double west = rectangle.x_min - x, east = rectangle.x_max - x;
  const double south = rectangle.z_min - z, north = rectangle.z_max - z;
  if (west >= radius || east <= -radius || south >= radius || north <= -radius) return 0;
  return disc_area_in_quadrant(radius, east, north) - disc_area_in_quadrant(radius, west, north) -
         disc_area_in_quadrant(radius, east, south) + disc_area_in_quadrant(radius, west, south);
}

}  // namespace drumlin::particles
