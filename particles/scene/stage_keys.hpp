#pragma once
// The keys of a stage, each described once (scene_keys.hpp).
#include "coupling/core/documents/key_table.hpp"
#include "particles/scene/stage.hpp"

namespace drumlin::particles {

template <class Visitor>
void describe(Visitor& v, Rotation& r) {
  v.value("speed_rpm", r.speed_rpm, required("turns/min", at_least(-1e6, 1e6), "Positive clockwise."));
  v.value("center_mm", r.center_mm,
          defaulted("mm", coordinate_mm(), "Point [x, z] about which the wall turns."));
}

template <class Visitor>
void describe(Visitor& v, Translation& t) {
  v.value("velocity_mm_s", t.velocity_mm_s, required("mm/s", at_least(-1e9, 1e9), "Velocity [v_x, v_z]."));
}

template <class Visitor>
void describe(Visitor& v, Oscillation& o) {
  v.value("amplitude_mm", o.amplitude_mm, required("mm", coordinate_mm(), "Amplitude [x, z]."));
  v.value("frequency_hz", o.frequency_hz, required("Hz", above(0, 1e6), "Frequency."));
  v.value("phase_deg", o.phase_deg,
          defaulted("deg", at_least(-360, 360),
                    "Motion: amplitude (sin(2 pi f t + phase) - sin(phase)), t from the stage's start."));
}

template <class Visitor>
void describe(Visitor& v, Rocking& r) {
  v.value("amplitude_deg", r.amplitude_deg, required("deg", at_least(-360, 360), "Amplitude, clockwise."));
  v.value("frequency_hz", r.frequency_hz, required("Hz", above(0, 1e6), "Frequency."));
  v.value("phase_deg", r.phase_deg,
          defaulted("deg", at_least(-360, 360),
                    "Motion: amplitude (sin(2 pi f t + phase) - sin(phase)), t from the stage's start."));
  v.value("center_mm", r.center_mm,
          defaulted("mm", coordinate_mm(), "Point [x, z] about which the wall turns."));
}

template <class Visitor>
void describe(Visitor& v, Belt& b) {
  v.value("speed_mm_s", b.speed_mm_s,
          required("mm/s", at_least(-1e9, 1e9),
                   "From a segment's first end to the other; clockwise round other shapes."));
}

template <class Visitor>
void describe(Visitor& v, WallMotion& m) {
  v.value("wall", m.wall, required("", not_empty(), "Its name."));
  v.variant("kind", m.motion, "Kind.", alternative<Rotation>("rotation", "about a point."),
            alternative<Translation>("translation", "along a line."),
            alternative<Oscillation>("oscillation", "along a line, to and fro."),
            alternative<Rocking>("rocking", "about a point, to and fro."),
            alternative<ForceControl>("force", "along a line, as force and grains push."),
            alternative<PressureControl>("pressure", "the same."),
            alternative<StrainRate>("strain_rate", "distance changes at a constant rate."),
            alternative<Belt>("belt", "the surface runs, the shape rests."));
}

template <class Visitor>
void describe(Visitor& v, UntilRest& u) {
  v.value("energy", u.energy,
          defaulted("", above(0, 1e6), "Kinetic energy per grain, in weights of the mean disc times d."));
  v.value("for_s", u.for_s, required("s", at_least(0), "Below that for so long."));
}

template <class Visitor>
void describe(Visitor& v, UntilMoved& u) {
  v.value("wall", u.wall, required("", not_empty(), "Its name."));
  v.value("distance_mm", u.distance_mm,
          required("mm", above(0, 1e6), "By the middle of its first shape, in this stage."));
}

template <class Visitor>
void describe(Visitor& v, UntilOut& u) {
  v.value("outlet", u.outlet, required("", not_empty(), "Its name."));
  v.value("count", u.count, required("", at_least(1, 1e8), "So many in this stage."));
}

template <class Visitor>
void describe(Visitor& v, Until& u) {
  v.optional_table("at_rest", u.at_rest, "Grains are at rest.");
  v.optional_table("moved", u.moved, "A wall has moved.");
  v.optional_table("out", u.out, "An outlet has taken grains.");
}

template <class Visitor>
void describe(Visitor& v, Stage& s) {
  v.value("name", s.name, required("", not_empty(), "Name, in the log."));
  v.value("duration_s", s.duration_s, when_given("s", above(0), "This or turns."));
  v.value("turns", s.turns, when_given("turns", above(0), "Of the first rotation among its motions."));
  v.value("time_step_s", s.time_step_s,
          required("s", above(0), "Adapted so that whole steps fill the stage."));
  v.value("snapshots", s.snapshots,
          defaulted("", at_least(0, most_snapshots), "Evenly spread, last at the end."));
  v.tables("motions", s.motions, 0,
           "Those of one wall act in their order, each on what those before it leave.");
  v.value("opens", s.opens, when_given("", not_empty(), "Walls gone from its start on."));
  v.optional_table("gravity", s.gravity, "Stays until another stage changes it.");
  each_effect(
      [&v]<class E>(auto& values, const std::optional<E>&) {
        if constexpr (HasPairs<E>)
          v.optional_table(E::name, values, std::string("In place of effects.") + E::name + ".");
      },
      s.effects, Effects{});
  v.optional_table("until", s.until, "Ends the stage when the first is met.");
  v.optional_table("cell", s.cell, "How the cell of periodic_z moves.");
}

}  // namespace drumlin::particles
