#pragma once
// Spin of the grains: their angular velocity, which friction alone can change. One number more per grain.
#include "particles/bodies/bodies.hpp"
#include "particles/detection/candidate.hpp"
#include "particles/effects/law_input.hpp"

namespace drumlin::particles {

/// The key: a table without entries.
struct Spin {
  static constexpr const char *name = "spin", *sentence = "Angular velocity of the grains; needs friction.";
  static constexpr const char* modest_text = "";
  static Spin modest() { return {}; }
  void check(const auto& scene, auto refuse) const {
    if (!scene.effects.friction)
      refuse("acts without friction", "together with effects.friction, or not at all", "effects.friction");
  }
};
inline Spin law_of(const Spin& spin, const LawInput&) { return spin; }

template <class Visitor>
void describe(Visitor&, Spin&) {}

// Terms in a step; the inertia is in W (contact/disc_delassus.hpp).

/// Sliding velocity of a contact from that of the centres: the rims of discs that spin slide against it.
inline double surface_sliding(double u_t, const Candidate& pair, const Bodies& bodies) {
  u_t -= bodies.radius[pair.i] * bodies.spin[pair.i];
  if (pair.j >= 0) u_t -= bodies.radius[pair.j] * bodies.spin[pair.j];
  return u_t;
}

/// Adds a change of a rim's velocity, as the contact problem counts it, to the spin.
inline void spin_up(Bodies& bodies, std::size_t b, double rim_change) {
  bodies.spin[b] += rim_change / bodies.radius[b];
}

}  // namespace drumlin::particles
