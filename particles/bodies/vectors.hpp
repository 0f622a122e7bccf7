#pragma once
// Vectors of the plane: sums, parts along a unit normal n and its tangent (n_z, -n_x).
#include "particles/bodies/bodies.hpp"
#include "particles/bodies/free_motion.hpp"
#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

inline Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.z + b.z}; }
inline Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.z - b.z}; }
inline Point operator*(double factor, const Point& a) { return {factor * a.x, factor * a.z}; }
inline void operator+=(Point& a, const Point& b) { a.x += b.x, a.z += b.z; }
inline void operator-=(Point& a, const Point& b) { a.x -= b.x, a.z -= b.z; }
inline bool is_zero(const Point& a) { return a.x == 0 && a.z == 0; }

inline double dot(const Point& a, const Point& b) { return a.x * b.x + a.z * b.z; }
/// Tangential part.
inline double across(const Point& n, const Point& u) { return n.z * u.x - n.x * u.z; }
/// The vector with these parts.
inline Point with_parts(const Point& n, double normal, double tangential) {
  return {n.x * normal + n.z * tangential, n.z * normal - n.x * tangential};
}

inline Point position(const Bodies& bodies, std::size_t b) { return {bodies.x[b], bodies.z[b]}; }
inline Point velocity(const Bodies& bodies, std::size_t b) { return {bodies.v_x[b], bodies.v_z[b]}; }
inline Point velocity(const FreeMotion& free, std::size_t b) { return {free.x[b], free.z[b]}; }
/// From the position of a grain to where its path begins.
inline PathShift shift(const FreeMotion& free, std::size_t b) {
  return free.shift.empty() ? PathShift{} : free.shift[b];
}

}  // namespace drumlin::particles
