#pragma once
// Rectangles, what lies in them of a line, and exact areas of a disc within them: volume fractions by
// coverage need nothing else.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace drumlin::particles {

struct Rectangle {
  double x_min = 0, x_max = 0, z_min = 0, z_max = 0;
  double width() const { return x_max - x_min; }
  double height() const { return z_max - z_min; }
  double area() const { return width() * height(); }
  bool holds(double x, double z) const { return x >= x_min && x < x_max && z >= z_min && z < z_max; }
  /// Takes in another one.
  void widen(const Rectangle& other) {
    x_min = std::min(x_min, other.x_min), x_max = std::max(x_max, other.x_max);
    z_min = std::min(z_min, other.z_min), z_max = std::max(z_max, other.z_max);
  }
};
/// What holds nothing, until it is widened.
inline constexpr Rectangle no_rectangle{
    std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
    std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

/// The part of a straight line from p to p + step that is left of it: p + s step, s = begin ... end.
struct LinePart {
  double begin = 0, end = 1;
  bool empty() const { return !(begin < end); }
  /// Cuts it to low ... high of one coordinate.
  void cut(double start, double step, double low, double high) {
    if (step == 0) {
      if (start < low || start > high) end = begin;
      return;
    }
    const double a = (low - start) / step, b = (high - start) / step;
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
};

/// Half of the points of Gauss' rule of order 12 over -1 ... 1, and their weights.
inline constexpr std::array<std::array<double, 2>, 6> gauss_points{
    {{0.1252334085114689, 0.2491470458134028},
     {0.3678314989981802, 0.2334925365383548},
     {0.5873179542866175, 0.2031674267230659},
     {0.7699026741943047, 0.1600783285433462},
     {0.9041172563704749, 0.1069393259953184},
     {0.9815606342467193, 0.0471753363865118}}};

/// Area of a disc centred at the origin within {x <= a}.
double disc_area_left_of(double radius, double a);
/// Area of a disc centred at the origin within {x <= a, z <= b}.
double disc_area_in_quadrant(double radius, double a, double b);
/// Area common to a disc and a rectangle.
double disc_area_in(double x, double z, double radius, const Rectangle& rectangle);

/// Volume of a sphere centred at the origin within {x <= a}.
double sphere_volume_left_of(double radius, double a);
/// Volume of a sphere of which `area_of(r)` is the part of its cross section of radius r: by Gauss' rule,
/// exact for a whole sphere, so that the parts of a sphere add up to it.
template <class Area>
double sphere_volume(double radius, const Area& area_of) {
  double volume = 0;
  for (const auto& [place, weight] : gauss_points)
    volume += 2 * weight * radius * area_of(radius * std::sqrt(1 - place * place));
  return volume;
}

}  // namespace drumlin::particles
