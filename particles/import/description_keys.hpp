#pragma once
// Keys of a description of foreign snapshots, each described once (coupling/core/documents/key_table.hpp).
#include "coupling/core/documents/key_table.hpp"
#include "particles/import/description.hpp"
#include "particles/scene/scene_keys.hpp"

namespace drumlin::particles {

inline constexpr const char* import_format = "drumlin-import-1";

inline Allowed some_texts() { return Allowed{}; }

template <class Visitor>
void describe(Visitor& v, CsvSource& s) {
  v.value("grains", s.grains, required("", some_texts(), "Files; * stands for any text."));
  v.value("columns", s.columns,
          defaulted("", anything(), "Names of the columns of files of grains without a line of names."));
  v.value("heading", s.heading,
          defaulted("", anything(), "Names in the line above each snapshot: count, time_s, others."));
  v.value("contacts", s.contacts, defaulted("", anything(), "As grains."));
  v.value("interval_s", s.interval_s,
          when_given("s", above(0, 1e9), "From file to file, where no column is time."));
}

template <class Visitor>
void describe(Visitor& v, FilesSource& s) {
  v.value("grains", s.grains, required("", some_texts(), "Files; * stands for any text."));
  v.value("columns", s.columns,
          defaulted("", anything(), "Names behind attrs of Yade's text: v_x, v_y, v_z, id, ..."));
  v.value("plane", s.plane, defaulted("", one_of<DumpPlane>(), "Of discs: its second axis becomes z."));
  v.value("step_s", s.step_s, when_given("s", above(0, 1e6), "One time step, of files that count them."));
  v.value("interval_s", s.interval_s, when_given("s", above(0, 1e9), "From file to file, without any time."));
  v.value("length_unit_m", s.length_unit_m,
          when_given("m", above(0, 1e6), "Of the files; without: what they say, else 1."));
  v.value("time_unit_s", s.time_unit_s,
          when_given("s", above(0, 1e6), "Likewise, in times, velocities and forces."));
  v.value("mass_unit_kg", s.mass_unit_kg, when_given("kg", above(0, 1e12), "Likewise, in forces."));
  v.value("wall_types", s.wall_types, defaulted("", anything(), "Types that are walls."));
  v.value("contacts", s.contacts, defaulted("", anything(), "As grains."));
  v.value("contact_ids", s.contact_ids, defaulted("", anything(), "Columns or arrays with both ids."));
  v.value("contact_forces", s.contact_forces,
          defaulted("", anything(),
                    "Columns of the force along the axes, of two parts one behind the other; arrays."));
  v.value("wall_ids", s.wall_ids, defaulted("", anything(), "Ids in contacts that are walls."));
  v.value("force_on", s.force_on, defaulted("", one_of<ForceOn>(), "Grain on which the force acts."));
  v.value("depth_m", s.depth_m,
          when_given("m", above(0, 1e6),
                     "Of discs: divides forces. For one layer of spheres: two thirds of the diameter."));
}

template <class Visitor>
void describe(Visitor& v, ImportedGrains& g) {
  v.value("density_kg_m3", g.density_kg_m3,
          required("kg/m3", above(0, 1e6), "Density of a disc or a sphere."));
  v.value("mean_diameter_m", g.mean_diameter_m,
          when_given("m", above(0, 1e6), "d; without: the first snapshot's. Dimensionless files need it."));
  v.value("may_change", g.may_change, defaulted("", anything(), "Grains may come and go."));
  v.value("velocities", g.velocities,
          defaulted("", one_of<ImportedVelocities>(),
                    "displacements: since the snapshot before; the first one is left out."));
}

template <class Visitor>
void describe(Visitor& v, ImportedDrum& d) {
  v.value("center_m", d.center_m, defaulted("m", at_least(-1e6, 1e6), "Axis [x, z]."));
  v.value("radius_m", d.radius_m, required("m", above(0, 1e6), "Inner radius."));
  v.value("speed_rpm", d.speed_rpm, defaulted("turns/min", at_least(-1e6, 1e6), "Positive clockwise."));
  v.value("turns_before", d.turns_before,
          defaulted("turns", at_least(0, 1e9), "Before the first snapshot; a steady drum needs one."));
}

template <class Visitor>
void describe(Visitor& v, ImportedPeriod& p) {
  v.value("length_m", p.length_m, required("m", above(0, 1e6), "Period."));
}

template <class Visitor>
void describe(Visitor& v, ImportDescription& d) {
  v.format(import_format);
  v.value("title", d.title, defaulted("", title_line(), "For reports."));
  v.value("reduced", d.reduced, defaulted("", anything(), "Marks every output as a trial."));
  v.value("dimensions", d.dimensions, defaulted("", at_least(2, 3), "3: spheres, with z up."));
  v.one_table_of(d.source, "Snapshots:", alternative<CsvSource>("csv", "tables."),
                 alternative<LammpsSource>("lammps", "dumps."),
                 alternative<FilesSource>("files", "files of any known format."));
  v.table("grains", d.grains, Need::required, "The grains.");
  v.table("gravity", d.gravity, Need::defaulted, "Gravity.");
  v.optional_table("drum", d.drum, "A circular drum.");
  v.optional_table("periodic_x", d.periodic_x, "Periodic domain.");
  v.optional_table("periodic_y", d.periodic_y, "Likewise, of spheres in files without a box.");
  v.value("time_step_s", d.time_step_s, when_given("s", above(0, 1e6), "For the record."));
}

}  // namespace drumlin::particles
