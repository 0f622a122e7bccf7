#pragma once
// Uniform gravity: one acceleration of all grains, explicit in time. Sets the unit of time, sqrt(d/g).
#include "coupling/core/documents/key_spec.hpp"
#include "particles/bodies/bodies.hpp"
#include "particles/bodies/free_motion.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/effects/law_input.hpp"

namespace drumlin::particles {

struct Gravity {
  static constexpr const char *name = "gravity", *sentence = "Uniform gravity.";
  static constexpr const char* modest_text = "9.81 m/s2 down";
  static Gravity modest() { return {}; }

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
struct GravityLaw : Point {
  GravityLaw(const Point& acceleration) : Point(acceleration) {}

  void move_freely(const Bodies&, std::size_t begin, std::size_t end, double time_step,
                   FreeMotion& free) const {
    const Point gain{time_step * x, time_step * z};
    for (std::size_t b = begin; b < end; ++b) free.x[b] += gain.x, free.z[b] += gain.z;
  }
};
GravityLaw law_of(const Gravity&, const LawInput&);

}  // namespace drumlin::particles
