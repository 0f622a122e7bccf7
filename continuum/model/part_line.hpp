#pragma once
// The line of a part of a region at a time, by its arc length.
#include "continuum/model/region.hpp"

namespace drumlin::continuum {

/// s from 0 to `length`: along a segment from its start, on a circle anticlockwise from the right.
struct PartLine {
  Vec2 start;         ///< of a segment; centre of a circle
  Vec2 along;         ///< unit vector of a segment
  double length = 0;  ///< d
  double radius = 0;  ///< 0: straight
  bool round() const { return radius > 0; }
  Vec2 at(double s) const;
  Vec2 tangent(double s) const;
  /// s of the nearest point of the line, which goes on beyond the ends of a segment.
  double nearest(Vec2 point) const;
  double distance(Vec2 point) const;
};
/// A segment moves with the velocity of its part from `begins` on.
PartLine line_of(const RegionPart& part, double time);

/// Of a segment, its ends included.
Vec2 nearest_point(const SegmentCurve& segment, Vec2 point);

bool is_there(const RegionPart& part, double time);
/// Not of an opening whose time has not come.
bool is_open(const RegionPart& part, double time);

}  // namespace drumlin::continuum
