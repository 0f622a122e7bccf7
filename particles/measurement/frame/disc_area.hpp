#pragma once
// Rectangles, what lies in them of a line, and exact areas of a disc within them: volume fractions by
// coverage need nothing else.
#include <algorithm>
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

/// Area of a disc centred at the origin within {x <= a}.
double disc_area_left_of(double radius, double a);
/// Area of a disc centred at the origin within {x <= a, z <= b}.
double disc_area_in_quadrant(double radius, double a, double b);
/// Area common to a disc and a rectangle.
double disc_area_in(double x, double z, double radius, const Rectangle& rectangle);

}  // namespace drumlin::particles
