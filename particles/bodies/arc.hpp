#pragma once
// Geometry of an arc: which of its points a disc touches, how far it reaches.
#include <array>
#include <vector>

#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

/// The point at an angle from the joint, anticlockwise.
Point at(const Arc&, double angle);
/// Unit direction from the end along the half.
Point tangent_at_end(const Arc&);
/// Points from the joint to the end that cut the half into equal pieces.
std::vector<Point> points_of(const Arc&, int pieces);
/// Angle of a point about the centre, from the joint, anticlockwise, -pi to pi.
double angle_from_joint(const Arc&, Point);
/// The point of the half that a disc with its centre there can touch: on the circle beside the half, else its
/// end. Near the joint both halves have the same point.
Point nearest_on(const Arc&, Point);
/// Whether that point is the end.
bool nearest_is_end(const Arc&, Point);

Reaches reaches_of(const Arc&);

/// The two halves of a circle's piece from an angle to a greater one, anticlockwise from +x, less than a
/// turn.
std::array<Arc, 2> halves_of(Point center, double radius, double from, double to);

}  // namespace drumlin::particles
