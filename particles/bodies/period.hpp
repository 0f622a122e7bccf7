#pragma once
// The periodic domain: open, periodic in x, or a cell that is periodic in x and z, whose images may stand
// askew and move against each other.
#include <cmath>

#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

/// Length 0: open along that axis; periodic in z only together with x. The image above is displaced by
/// (offset, length_z), the one to the right by (length, 0). An image displaced by s moves at
/// (rate_x s_x + shear s_z, rate_z s_z) against its original.
struct Period {
  double origin = 0;
  double length = 0;
  double origin_z = 0;
  double length_z = 0;
  double offset = 0;
  double rate_x = 0, rate_z = 0, shear = 0;

  bool open() const { return length <= 0; }
  bool open_z() const { return length_z <= 0; }
  /// Whether images move.
  bool moves() const { return rate_x != 0 || rate_z != 0 || shear != 0; }

  /// The nearest image of a difference; along x alone where z is open.
  double nearest(double dx) const { return open() ? dx : dx - length * std::round(dx / length); }
  Point nearest(Point d) const {
    if (!open_z()) {
      const double cells = std::round(d.z / length_z);
      d.x -= offset * cells, d.z -= length_z * cells;
    }
    return {nearest(d.x), d.z};
  }
  /// The image in the first period.
  double first(double x) const { return open() ? x : x - length * std::floor((x - origin) / length); }
  Point first(Point p) const {
    if (!open_z()) {
      const double cells = std::floor((p.z - origin_z) / length_z);
      p.x -= offset * cells, p.z -= length_z * cells;
    }
    return {first(p.x), p.z};
  }
  /// Velocity of an image that is displaced by `shift`.
  Point image_velocity(Point shift) const { return {rate_x * shift.x + shear * shift.z, rate_z * shift.z}; }
};

}  // namespace drumlin::particles
