#pragma once
// A convex polygon that is cut by lines, with its exact area within discs: a cell of a tessellation.
#include <span>
#include <vector>

namespace drumlin::particles {

struct PlanePoint {
  double x = 0, z = 0;
};

struct Circle {
  double x = 0, z = 0, radius = 0;
};

/// Corners anticlockwise (x to the right, z up); empty when nothing is left. Its memory is kept when it is
/// cut or made anew.
class ConvexPolygon {
 public:
  /// A square about the origin.
  void make_square(double half_side);
  /// Keeps {normal . p <= offset}. The normal need not have length 1, but must not be zero.
  void cut(double normal_x, double normal_z, double offset);
  std::span<const PlanePoint> corners() const { return corners_; }
  bool empty() const { return corners_.empty(); }
  void clear() { corners_.clear(); }
  /// Largest squared distance of a corner from the origin; 0 when empty.
  double largest_distance_squared() const;
  double area() const;

 private:
  std::vector<PlanePoint> corners_, old_;
};

/// A convex polygon within discs.
struct RoundedArea {
  double area = 0;
  /// Length of the boundary on the first circle: 0 when the first disc cuts nothing off.
  double length_on_first = 0;
};

/// Area of a polygon within one disc or two, exact: its boundary is made of pieces of edges and arcs of
/// circles.
RoundedArea area_within(const ConvexPolygon& polygon, std::span<const Circle> discs);

}  // namespace drumlin::particles
