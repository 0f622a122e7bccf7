#pragma once
// Gravity that a stage changes: another strength or direction, at once or as a ramp over the stage (a bed
// that is tilted until it slides). What a stage reaches stays until another one changes it.
#include <optional>

#include "coupling/core/documents/key_spec.hpp"
#include "particles/effects/gravity.hpp"

namespace drumlin::particles {

struct StageGravity {
  std::optional<double> acceleration_m_s2 = {};  ///< absent: as before
  std::optional<double> direction_deg = {};      ///< absent: as before
  bool ramp = false;
};

template <class Visitor>
void describe(Visitor& v, StageGravity& g) {
  v.value("acceleration_m_s2", g.acceleration_m_s2,
          when_given("m/s2", at_least(0, 1e6), "Without: as before."));
  v.value("direction_deg", g.direction_deg,
          when_given("deg", at_least(-360, 360), "Anticlockwise from +x; without: as before."));
  v.value("ramp", g.ramp, defaulted("", anything(), "Changes at even rates over the full stage."));
}

/// Gravity in a stage that finds `before` and of whose full length the share `done` (0 to 1) has passed.
/// Direction and strength change at even rates: through the angles between the two as numbers.
Gravity gravity_in_stage(const std::optional<StageGravity>& requested, const Gravity& before, double done);

}  // namespace drumlin::particles
