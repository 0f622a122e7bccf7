#pragma once
// The keys of a scene file, each described once: docs/formats/scene.md, reading, writing and `drumlin scene
// keys` follow from this (coupling/core/documents/key_table.hpp). The keys of an effect stand beside its law,
// in particles/effects.
#include "coupling/core/documents/key_table.hpp"
#include "particles/scene/scene.hpp"
#include "particles/scene/stage_keys.hpp"
#include "particles/scene/traffic_keys.hpp"

namespace drumlin::particles {

inline constexpr const char* scene_format = "drumlin-scene-1";

template <class Visitor>
void describe(Visitor& v, PeriodicX& p) {
  v.value("x_min_mm", p.x_min_mm, required("mm", coordinate_mm(), "Left end."));
  v.value("x_max_mm", p.x_max_mm, required("mm", coordinate_mm(), "Right end."));
}

template <class Visitor>
void describe(Visitor& v, PeriodicZ& p) {
  v.value("z_min_mm", p.z_min_mm, required("mm", coordinate_mm(), "Lower end."));
  v.value("z_max_mm", p.z_max_mm, required("mm", coordinate_mm(), "Upper end."));
}

template <class Visitor>
void describe(Visitor& v, CircleRegion& r) {
  v.value("center_mm", r.center_mm, defaulted("mm", coordinate_mm(), "Centre [x, z]."));
  v.value("radius_mm", r.radius_mm, required("mm", length_mm(), "Radius."));
}

template <class Visitor>
void describe(Visitor& v, RectangleRegion& r) {
  v.value("min_mm", r.min_mm, required("mm", coordinate_mm(), "Lower left corner [x, z]."));
  v.value("max_mm", r.max_mm, required("mm", coordinate_mm(), "Upper right corner [x, z]."));
}

template <class Visitor>
void describe(Visitor& v, std::variant<CircleRegion, RectangleRegion>& region) {
  v.variant("shape", region, "Shape.", alternative<CircleRegion>("circle", "a disc."),
            alternative<RectangleRegion>("rectangle", "sides along x and z."));
}

inline KeySpec counted_by() {
  return when_given("", one_of<CountedBy>(), "What the distribution counts; without: number.");
}

template <class Visitor>
void describe(Visitor& v, TwoSizes& s) {
  v.value("small_share", s.small_share, required("", at_least(0, 1), "Share of the small."));
  v.value("by", s.by, counted_by());
}

template <class Visitor>
void describe(Visitor& v, PowerLawSizes& s) {
  v.value("exponent", s.exponent,
          required("", at_least(-20, 20), "a: number, or mass, per diameter ~ D^-a."));
  v.value("by", s.by, counted_by());
}

template <class Visitor>
void describe(Visitor& v, LognormalSizes& s) {
  v.value("median_mm", s.median_mm, required("mm", length_mm(), "Median, before the cut."));
  v.value("sigma", s.sigma, required("", above(0, 3), "Standard deviation of ln D, before the cut."));
  v.value("by", s.by, counted_by());
}

template <class Visitor>
void describe(Visitor& v, SieveSizes& s) {
  v.value("openings_mm", s.openings_mm, required("mm", length_mm(), "Openings of the sieves, ascending."));
  v.value("passing_share", s.passing_share,
          required("", at_least(0, 1),
                   "Share of the mass that passes each; even over ln D in between, from 0 at the smallest "
                   "diameter to 1 at the largest."));
}

template <class Visitor>
void describe(Visitor& v, Sizes& sizes) {
  v.variant("kind", sizes, "From smallest to largest.", alternative<TwoSizes>("two", "one or the other."),
            alternative<PowerLawSizes>("power_law", "a power of the diameter."),
            alternative<LognormalSizes>("lognormal", "normal in ln D, cut at both."),
            alternative<SieveSizes>("sieve", "a sieve analysis."));
}

template <class Visitor>
void describe(Visitor& v, GeneratedGrains& g) {
  v.value("count", g.count, required("", at_least(1, 1e8), "Number."));
  v.value("diameter_min_mm", g.diameter_min_mm, required("mm", length_mm(), "Smallest diameter."));
  v.value("diameter_max_mm", g.diameter_max_mm, required("mm", length_mm(), "Largest diameter."));
  v.table("region", g.region, Need::required, "Filled from below.");
  v.optional_table("sizes", g.sizes, "Of the diameters; without: uniform.");
  v.value("placement", g.placement,
          defaulted("", one_of<Placement>(), "apart: no contacts. deposited: each rolls into a hollow."));
  v.value("around", g.around,
          when_given("", not_empty(), "Walls that may reach into the region: grains keep clear of them."));
}

template <class Visitor>
void describe(Visitor& v, ListedGrains& g) {
  v.value("file", g.file,
          required("", not_empty(),
                   "CSV, path from the scene's folder: x_mm, z_mm, diameter_mm; optional v_x_mm_s, v_z_mm_s, "
                   "spin_rad_s, density_kg_m3, material."));
}

template <class Visitor>
void describe(Visitor& v, GrainMaterial& m) {
  v.value("name", m.name, required("", not_empty(), "Name."));
  v.value("share", m.share, defaulted("", above(0, 1e6), "Relative share of generated grains, by number."));
}

template <class Visitor>
void describe(Visitor& v, GrainsOfRun& g) {
  v.value("run", g.run, required("", not_empty(), "Its folder, from the scene's."));
  v.value("time_s", g.time_s, when_given("s", at_least(0), "Snapshot; without: the last."));
}

template <class Visitor>
void describe(Visitor& v, GrainGroup& g) {
  v.value("name", g.name, required("", not_empty(), "Name."));
  v.value("material", g.material, when_given("", not_empty(), "One of grains.materials."));
  v.value("density_kg_m3", g.density_kg_m3,
          when_given("kg/m3", above(0, 1e6), "Without: grains.density_kg_m3."));
  v.one_table_of(g.source, "Grains:", alternative<GeneratedGrains>("generated", "from a distribution."),
                 alternative<ListedGrains>("listed", "from a list."));
}

template <class Visitor>
void describe(Visitor& v, Grains& g) {
  v.value("density_kg_m3", g.density_kg_m3, required("kg/m3", above(0, 1e6), "Density of a disc."));
  v.tables("materials", g.materials, 0, "For laws by pair.");
  v.one_table_of(g.source, "Grains:", alternative<GeneratedGrains>("generated", "from a distribution."),
                 alternative<ListedGrains>("listed", "from a list."),
                 alternative<GrainsOfRun>("from_run", "another run's."));
  v.value("thermal_speed_mm_s", g.thermal_speed_mm_s,
          when_given("mm/s", above(0, 1e9),
                     "Adds Maxwell's velocities: no momentum, energy of all mass at this speed."));
  v.tables("groups", g.groups, 0, "More grains, behind the others.");
}

template <class Visitor>
void describe(Visitor& v, ContainerShape& c) {
  v.value("center_mm", c.center_mm, defaulted("mm", coordinate_mm(), "Centre [x, z]."));
  v.value("radius_mm", c.radius_mm, required("mm", length_mm(), "Radius."));
}

template <class Visitor>
void describe(Visitor& v, SegmentShape& s) {
  v.value("from_mm", s.from_mm, required("mm", coordinate_mm(), "One end [x, z]."));
  v.value("to_mm", s.to_mm, required("mm", coordinate_mm(), "Other end [x, z]."));
}

template <class Visitor>
void describe(Visitor& v, DiscShape& d) {
  v.value("center_mm", d.center_mm, required("mm", coordinate_mm(), "Centre [x, z]."));
  v.value("diameter_mm", d.diameter_mm, required("mm", length_mm(), "Diameter."));
}

template <class Visitor>
void describe(Visitor& v, PolylineShape& p) {
  v.value("x_mm", p.x_mm, required("mm", coordinate_mm(), "x of the points."));
  v.value("z_mm", p.z_mm, required("mm", coordinate_mm(), "z, as many."));
  v.value("closed", p.closed, when_given("", anything(), "Joins last and first point."));
}

template <class Visitor>
void describe(Visitor& v, ArcShape& a) {
  v.value("center_mm", a.center_mm, required("mm", coordinate_mm(), "Centre [x, z]."));
  v.value("radius_mm", a.radius_mm, required("mm", length_mm(), "Radius."));
  v.value("from_deg", a.from_deg, required("deg", at_least(-360, 360), "Begin, anticlockwise from +x."));
  v.value("to_deg", a.to_deg, required("deg", at_least(-360, 720), "End: above from_deg by less than 360."));
}

template <class Visitor>
void describe(Visitor& v, Roughness& r) {
  v.value("diameter_mm", r.diameter_mm, required("mm", length_mm(), "Diameter."));
  v.value("spacing_mm", r.spacing_mm, required("mm", length_mm(), "Along the wall; shortened to fit."));
}

template <class Visitor>
void describe(Visitor& v, Wall& w) {
  v.value("name", w.name, required("", not_empty(), "Shapes of one name move together."));
  v.variant("shape", w.shape, "Shape; lines are solid on both sides.",
            alternative<ContainerShape>("container", "circle around the grains."),
            alternative<SegmentShape>("segment", "straight line."), alternative<DiscShape>("disc", "solid."),
            alternative<PolylineShape>("polyline", "joined lines."),
            alternative<ArcShape>("arc", "part of a circle."));
  v.value("material", w.material, when_given("", not_empty(), "Material."));
  v.value("acts_on", w.acts_on,
          when_given("", not_empty(), "Materials of the grains that it meets; others pass. Without: all."));
  v.optional_table("rough", w.rough, "Discs glued along a container, a segment or a disc.");
}

template <class Visitor>
void describe(Visitor& v, Effects& e) {
  each_effect([&v]<class E>(std::optional<E>& effect) { v.optional_table(E::name, effect, E::sentence); }, e);
}

template <class Visitor>
void describe(Visitor& v, SolverSettings& s) {
  v.value("name", s.name, defaulted("", not_empty(), "Contact solver, \"accelerated\" or \"nlgs\"."));
  v.value("tolerance", s.tolerance, defaulted("", above(0, 10), "On the residual (docs/conventions.md)."));
  v.value("penetration_tolerance", s.penetration_tolerance,
          defaulted("d", above(0, 1e3), "On predicted penetration and sinking per step."));
  v.value("max_sweeps", s.max_sweeps, defaulted("", at_least(1, 1e7), "Stops in any case."));
  v.value("check_every", s.check_every, defaulted("", at_least(1, 1e7), "Sweeps from check to check."));
  v.value("projection_sweeps", s.projection_sweeps,
          defaulted("", at_least(0, 1e6), "Sweeps that remove overlap; 0: none."));
  v.value("projection_share", s.projection_share,
          when_given("", above(0, 1), "Of an overlap, taken off per step; absent: 0.2."));
  v.value("stop_when_unconverged", s.stop_when_unconverged,
          defaulted("", anything(), "Exit 3 at the first step that misses a tolerance."));
  v.value(
      "capture_unconverged", s.capture_unconverged,
      defaulted("", at_least(0, 1e6), "So many steps that miss a tolerance leave their contact problem."));
}

template <class Visitor>
void describe(Visitor& v, Output& o) {
  v.value("velocity_window_s", o.velocity_window_s,
          defaulted("s", at_least(0), "Window of stored displacements; 0: none."));
  v.value("log_every_steps", o.log_every_steps,
          defaulted("", at_least(1, 1e9), "Steps per line of the log."));
  v.value("checkpoint_every_s", o.checkpoint_every_s,
          defaulted("s", above(0), "Simulated time between checkpoints."));
  v.value("energy_ledger", o.energy_ledger, defaulted("", anything(), "Leaves energy.csv."));
  v.value("walls_every_s", o.walls_every_s,
          when_given("s", above(0), "Leaves walls.csv: means over such intervals."));
}

template <class Visitor>
void describe(Visitor& v, Scene& s) {
  v.format(scene_format);
  v.value("title", s.title, defaulted("", title_line(), "For reports."));
  v.value("reduced", s.reduced, defaulted("", anything(), "Marks every output as a trial."));
  v.value("seed", s.seed, defaulted("", at_least(0), "Of all random numbers."));
  v.optional_table("periodic_x", s.periodic_x, "Periodic domain; without: open.");
  v.table("grains", s.grains, Need::required, "The grains.");
  v.tables("walls", s.walls, 0, "One table per shape.");
  v.table("effects", s.effects, Need::defaulted, "Each acts if present.");
  v.tables("stages", s.stages, 1, "One after the other.");
  v.table("solver", s.solver, Need::defaulted, "Contact solver; when it stops.");
  v.table("output", s.output, Need::defaulted, "What is written.");
  v.tables("outlets", s.outlets, 0, "Regions that take grains away.");
  v.tables("sources", s.sources, 0, "Regions where grains are poured.");
  v.optional_table("periodic_z", s.periodic_z, "With periodic_x: a cell without walls and gravity.");
}

}  // namespace drumlin::particles
