#pragma once
// Sums and products of vectors in the plane.
#include <cmath>

#include "continuum/model/flow_problem.hpp"

namespace drumlin::continuum {

inline Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.z + b.z}; }
inline Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.z - b.z}; }
inline Vec2 operator*(double s, Vec2 a) { return {s * a.x, s * a.z}; }
inline double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.z * b.z; }
/// Positive where b lies to the left of a.
inline double cross(Vec2 a, Vec2 b) { return a.x * b.z - a.z * b.x; }
inline double length(Vec2 a) { return std::hypot(a.x, a.z); }

}  // namespace drumlin::continuum
