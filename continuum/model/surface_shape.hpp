#pragma once
// Shape of a free surface that has moved, and displacement of the points below it.
#include <vector>

#include "continuum/model/flow_problem.hpp"

namespace drumlin::continuum {

/// Height over the place that the domain gives the surface, z = 0: the sum of coefficient[n] T_n(s) over
/// Chebyshev's polynomials, -1 <= s <= 1. s = x/W(z), W(z) being half of the width of the domain (a chord's
/// disc, a box) at the height z: lines of equal s end at s = +-1 in the wall, so that the ends of the surface
/// slide along it, wherever they go. T_n is finest at the ends, where the shape bends most.
struct SurfaceShape {
  Domain domain;
  std::vector<double> coefficient;  ///< d
};

double rise(const SurfaceShape& shape, double s);        ///< height at s, d
double rise_slope(const SurfaceShape& shape, double s);  ///< its derivative by s
double chebyshev(std::size_t n, double s);
/// x/W(z), within -1 .. 1.
double across(const SurfaceShape& shape, Vec2 point);
/// The point of the surface at s.
Vec2 surface_point(const SurfaceShape& shape, double s);
/// Its outward normal, a unit vector.
Vec2 surface_normal(const SurfaceShape& shape, double s);
/// Height of the surface at x, between its ends; nought at an x beyond them.
double height(const SurfaceShape& shape, double x);
/// Largest height, of either sign.
double largest_height(const SurfaceShape& shape);
/// Largest z of it.
double highest_point(const SurfaceShape& shape);
/// Slope (rad, positive where the surface falls towards +x) of the straight line fitted to the surface over
/// |x| < half_length, evenly in s.
double mean_slope(const SurfaceShape& shape, double half_length);
/// Area between the surface and z = 0, that below counted negative.
double area_above(const SurfaceShape& shape);
/// Changes the first two coefficients so that area_above is nought, and mean_slope over `half_length` too;
/// half_length = 0 leaves the second one as it is. That takes to rest what no pressure can: the fill, and a
/// turn of the whole, which the slope of the axes stands for.
void restrain(SurfaceShape& shape, double half_length);

/// Where a point of the undisturbed domain goes: along its line of equal s, by the height of the surface
/// there times (1 + z/reach)^2, reach being 0.8 of the depth; not at all below that.
Vec2 displaced(const SurfaceShape& shape, Vec2 point);

}  // namespace drumlin::continuum
