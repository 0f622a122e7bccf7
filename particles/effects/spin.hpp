#pragma once
// Spin of the grains: their angular velocity, which friction alone can change. One number more per grain.
#include "particles/bodies/bodies.hpp"
#include "particles/detection/candidate.hpp"

namespace drumlin::particles {

/// The key: a table without entries.
struct Spin {};

template <class Visitor>
void describe(Visitor&, Spin&) {}

// Terms in a step; the inertia is in W (contact/body_delassus.hpp, with_spin).

/// Sliding velocity of a contact from that of the centres: the rims of discs that spin slide against it.
inline double sliding_of_rims(double u_t, const Candidate& pair, const Bodies& bodies) {
  u_t -= bodies.radius[pair.i] * bodies.spin[pair.i];
  if (pair.j >= 0) u_t -= bodies.radius[pair.j] * bodies.spin[pair.j];
  return u_t;
}

/// Adds a change of a rim's velocity, as the contact problem counts it, to the spin.
inline void spin_up(Bodies& bodies, std::size_t b, double rim_change) {
  bodies.spin[b] += rim_change / bodies.radius[b];
}

}  // namespace drumlin::particles
