#pragma once
// The keys of a region, each described once (coupling/core/documents/key_table.hpp).
#include "continuum/model/flow_region.hpp"
#include "coupling/core/documents/key_table.hpp"

namespace drumlin::continuum {

inline Allowed place_mm() { return at_least(-1e6, 1e6); }

template <class Visitor>
void describe(Visitor& v, FlowSegment& s) {
  v.value("from_mm", s.from_mm, required("mm", place_mm(), "One end [x, z]."));
  v.value("to_mm", s.to_mm, required("mm", place_mm(), "Other end [x, z]."));
  v.value("velocity_mm_s", s.velocity_mm_s,
          defaulted("mm/s", at_least(-1e6, 1e6), "The wall goes along; from begins_s on."));
}
template <class Visitor>
void describe(Visitor& v, FlowCircle& c) {
  v.value("center_mm", c.center_mm, defaulted("mm", place_mm(), "Centre [x, z]."));
  v.value("radius_mm", c.radius_mm, required("mm", above(0, 1e6), "Radius."));
  v.value("rotation_rpm", c.rotation_rpm,
          defaulted("rpm", at_least(-1e4, 1e4), "As in a drum, clockwise as drawn; from begins_s on."));
}
template <class Visitor>
void describe(Visitor&, FlowRoughWall&) {}
template <class Visitor>
void describe(Visitor& v, FlowFrictionWall& w) {
  v.value("friction", w.friction, required("", above(0, 2), "Of the wall against the grains."));
}
template <class Visitor>
void describe(Visitor&, FlowSmoothWall&) {}
template <class Visitor>
void describe(Visitor& v, FlowWall& w) {
  v.value("name", w.name, required("", not_empty(), "Walls of one name are measured together."));
  v.variant("shape", w.shape, "Shape.", alternative<FlowSegment>("segment", "straight, between two points."),
            alternative<FlowCircle>("circle", "around the material."));
  v.variant("condition", w.condition, "Of the material.", alternative<FlowRoughWall>("rough", "no slip."),
            alternative<FlowFrictionWall>("friction", "Coulomb."),
            alternative<FlowSmoothWall>("smooth", "slides freely."));
  v.value("begins_s", w.begins_s, defaulted("s", at_least(0, 1e9), "At rest before."));
  v.value("ends_s", w.ends_s, when_given("s", at_least(0, 1e9), "Gone from then on; absent: stays."));
}
template <class Visitor>
void describe(Visitor& v, FlowOpening& o) {
  v.value("name", o.name, required("", not_empty(), "Name."));
  v.value("from_mm", o.from_mm, required("mm", place_mm(), "One end [x, z]."));
  v.value("to_mm", o.to_mm, required("mm", place_mm(), "Other end [x, z]."));
  v.value("begins_s", o.begins_s, defaulted("s", at_least(0, 1e9), "A rough wall before."));
}
template <class Visitor>
void describe(Visitor& v, RegionMeshKeys& m) {
  v.value("cell", m.cell, defaulted("d", at_least(0.05, 100), "Largest cell."));
  v.value("slot_cell", m.slot_cell, defaulted("d", at_least(0.05, 100), "Largest cell at an opening."));
}
template <class Visitor>
void describe(Visitor& v, RegionTime& t) {
  v.value("end_s", t.end_s, required("s", above(0, 1e6), "End."));
  v.value("step_s", t.step_s, required("s", above(0, 1e6), "Largest step."));
  v.value("frames_s", t.frames_s, when_given("s", at_least(0, 1e6), "Times of frames, ascending."));
  v.value("frames_every_s", t.frames_every_s, when_given("s", above(0, 1e6), "In place of frames_s."));
}
template <class Visitor>
void describe(Visitor& v, RegionOutput& o) {
  v.value("map_spacing", o.map_spacing, defaulted("d", at_least(1e-3, 100), "Of frames.h5."));
  v.value("x_mm", o.x_mm, when_given("mm", place_mm(), "From, to; absent: all walls and the fill."));
  v.value("z_mm", o.z_mm, when_given("mm", place_mm(), "The same upwards."));
  v.value("figures", o.figures, defaulted("", anything(), "Draws figures."));
}
template <class Visitor>
void describe(Visitor& v, FlowRegion& r) {
  v.value("fill_mm", r.fill_mm,
          required("mm", place_mm(), "Outline of the material at the start, [[x, z], ...], anticlockwise."));
}

}  // namespace drumlin::continuum
