#pragma once
// Keys of a description of foreign snapshots, each described once (coupling/documents/key_table.hpp).
#include "coupling/documents/key_table.hpp"
#include "particles/import/description.hpp"
#include "particles/scene/scene_keys.hpp"

namespace drumlin::particles {

inline constexpr const char* import_format = "drumlin-import-1";

inline Allowed some_texts() { return Allowed{}; }

template <class Visitor>
void describe(Visitor& v, CsvSource& s) {
  v.value("grains", s.grains, required("", some_texts(), "Files of grains, names or patterns with *."));
  v.value("contacts", s.contacts, defaulted("", anything(), "Files of contacts, likewise."));
  v.value("interval_s", s.interval_s,
          when_given("s", above(0, 1e9),
                     "Time from one file to the next, where the files have no column of time."));
}

template <class Visitor>
void describe(Visitor& v, LammpsSource& s) {
  v.value("grains", s.grains,
          required("", some_texts(), "Dumps of the style custom, names or patterns with *."));
  v.value("plane", s.plane,
          defaulted("", one_of({"xy", "xz"}), "Plane of the grains; its second axis becomes z."));
  v.value("step_s", s.step_s, required("s", above(0, 1e6), "Duration of one time step of the dump."));
  v.value("length_unit_m", s.length_unit_m, defaulted("m", above(0, 1e6), "The dump's unit of length."));
  v.value("time_unit_s", s.time_unit_s,
          defaulted("s", above(0, 1e6), "Its unit of time, in velocities and forces."));
  v.value("mass_unit_kg", s.mass_unit_kg, defaulted("kg", above(0, 1e12), "Its unit of mass, in forces."));
  v.value("wall_types", s.wall_types, defaulted("", anything(), "Atom types that are walls."));
  v.value("contacts", s.contacts, defaulted("", anything(), "Dumps of the style local."));
  v.value("contact_ids", s.contact_ids,
          defaulted("", anything(), "Their columns with the ids of both grains."));
  v.value("contact_forces", s.contact_forces,
          defaulted("", anything(), "Their columns with the force in the plane."));
  v.value("force_on", s.force_on,
          defaulted("", one_of({"first", "second"}), "Which of the two grains that force acts on."));
  v.value("depth_m", s.depth_m,
          when_given("m", above(0, 1e6),
                     "Forces are divided by it. For one layer of spheres two thirds of the diameter give a "
                     "disc the sphere's mass."));
}

template <class Visitor>
void describe(Visitor& v, ImportedGrains& g) {
  v.value("density_kg_m3", g.density_kg_m3, required("kg/m3", above(0, 1e6), "Density of a disc."));
  v.value("mean_diameter_m", g.mean_diameter_m,
          when_given("m", above(0, 1e6),
                     "d; without it that of the first snapshot. Needed by dimensionless files."));
  v.value("may_change", g.may_change, defaulted("", anything(), "Grains may come and go."));
}

template <class Visitor>
void describe(Visitor& v, ImportedDrum& d) {
  v.value("center_m", d.center_m, defaulted("m", at_least(-1e6, 1e6), "Its axis [x, z]."));
  v.value("radius_m", d.radius_m, required("m", above(0, 1e6), "Its inner radius."));
  v.value("speed_rpm", d.speed_rpm,
          defaulted("turns/min", at_least(-1e6, 1e6), "Positive clockwise as drawn."));
  v.value("turns_before", d.turns_before,
          defaulted("turns", at_least(0, 1e9),
                    "Turns before the first snapshot: a drum needs one to be steady."));
}

template <class Visitor>
void describe(Visitor& v, ImportedPeriod& p) {
  v.value("length_m", p.length_m, required("m", above(0, 1e6), "Length of the period."));
}

template <class Visitor>
void describe(Visitor& v, ImportDescription& d) {
  v.format(import_format);
  v.value("title", d.title, defaulted("", title_line(), "Title, for reports."));
  v.value("reduced", d.reduced,
          defaulted("", anything(), "Says \"reduced\" on every output: a trial, no result."));
  v.one_table_of(d.source, "Where the snapshots are.", alternative<CsvSource>("csv", "Tables of numbers."),
                 alternative<LammpsSource>("lammps", "Dumps of LAMMPS."));
  v.table("grains", d.grains, Need::required, "The grains.");
  v.table("gravity", d.gravity, Need::defaulted, "Gravity.");
  v.optional_table("drum", d.drum, "A circular drum.");
  v.optional_table("periodic_x", d.periodic_x, "Periodic domain in x.");
  v.value("time_step_s", d.time_step_s, when_given("s", above(0, 1e6), "Of that run, for the record."));
}

}  // namespace drumlin::particles
