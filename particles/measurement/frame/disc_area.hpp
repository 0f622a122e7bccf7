#pragma once
// Exact areas of a disc within rectangles: volume fractions by coverage need nothing else.

namespace drumlin::particles {

struct Rectangle {
  double x_min = 0, x_max = 0, z_min = 0, z_max = 0;
};

/// Area of a disc centred at the origin within {x <= a}.
double disc_area_left_of(double radius, double a);
/// Area of a disc centred at the origin within {x <= a, z <= b}.
double disc_area_in_quadrant(double radius, double a, double b);
/// Area common to a disc and a rectangle.
double disc_area_in(double x, double z, double radius, const Rectangle& rectangle);

}  // namespace drumlin::particles
