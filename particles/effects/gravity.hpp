#pragma once
// Uniform gravity: one acceleration of all grains, explicit in time. Sets the unit of time, sqrt(d/g).
#include "coupling/common/scales.hpp"
#include "coupling/documents/key_spec.hpp"
#include "particles/bodies/walls.hpp"

namespace drumlin::particles {

struct Gravity {
  double acceleration_m_s2 = 9.81;
  double direction_deg = -90;  ///< angle from +x, anticlockwise as drawn; -90 points down
};

template <class Visitor>
void describe(Visitor& v, Gravity& g) {
  v.value("acceleration_m_s2", g.acceleration_m_s2,
          defaulted("m/s2", above(0, 1e6), "Strength; sets the unit of time, sqrt(d/g)."));
  v.value("direction_deg", g.direction_deg,
          defaulted("deg", at_least(-360, 360), "Anticlockwise from +x; -90: down."));
}

/// The law: the acceleration in the units of the simulation.
Point gravity_law(const Gravity&, const Scales&);

}  // namespace drumlin::particles
