#pragma once
// Servo walls: a wall under a pressure, which is a driven wall whose force is the pressure times the length
// that it acts on; and a wall that strains what lies between it and a reference at a constant rate.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "coupling/core/basics/scales.hpp"
#include "coupling/core/documents/key_spec.hpp"
#include "particles/bodies/walls.hpp"
#include "particles/effects/driven_walls.hpp"

namespace drumlin::particles {

/// The keys of a motion of kind "pressure".
struct PressureControl {
  std::array<double, 2> direction{0, 0};  ///< of the force and of the motion; its length does not matter
  double pressure_n_m2 = 0;
  double mass_kg_m = 0;
  std::array<double, 2> velocity_mm_s{0, 0};  ///< at right angles to the direction
  /// Two walls whose distance across the direction is the length that the pressure acts on; without: the
  /// length of the wall itself, at most that of the period.
  std::optional<std::vector<std::string>> between = {};
};

template <class Visitor>
void describe(Visitor& v, PressureControl& p) {
  describe_drive(v, p, "pressure_n_m2", p.pressure_n_m2, "N/m2");
  v.value(
      "between", p.between,
      when_given("", not_empty(), "Two walls: pressed length, between the middles of their first shapes."));
}

/// The keys of a motion of kind "strain_rate".
struct StrainRate {
  std::array<double, 2> direction{0, 0};     ///< of the motion; its length does not matter
  std::array<double, 2> reference_mm{0, 0};  ///< a point that the strain leaves where it is
  double rate_per_s = 0;                     ///< of the distance from it; negative: compression
};

template <class Visitor>
void describe(Visitor& v, StrainRate& s) {
  v.value("direction", s.direction,
          required("", at_least(-1e6, 1e6), "Direction [x, z]; its length does not matter."));
  v.value("reference_mm", s.reference_mm,
          required("mm", at_least(-1e6, 1e6),
                   "Fixed point [x, z]; L: from it to the middle of the wall's first shape."));
  v.value("rate_per_s", s.rate_per_s,
          required("1/s", at_least(-1e6, 1e6), "L grows as exp(rate t); negative: compression."));
}

/// The laws, in the units of the simulation, of wall `wall` at the start of a stage. `state`: the position of
/// a pressed wall among the states of driven walls.
Driven pressed_law(const PressureControl&, const Walls&, int wall, const Scales&, int state);
Straining straining_law(const StrainRate&, const Walls&, int wall, const Scales&);

/// Length of a wall across a direction (a unit vector), as it stands when a stage begins: that of its
/// segments, at most the period. d
double length_across(const Walls&, int wall, Point direction);

}  // namespace drumlin::particles
