#pragma once
// The keys of a scene file, each described once: docs/formats/scene.md, reading, writing and `drumlin scene
// keys` follow from this (coupling/documents/key_table.hpp). The keys of an effect stand beside its law, in
// particles/effects.
#include "coupling/documents/key_table.hpp"
#include "particles/scene/scene.hpp"
#include "particles/scene/stage_keys.hpp"
#include "particles/scene/traffic_keys.hpp"
#include "particles/solver/contact_solver.hpp"

namespace drumlin::particles {

inline constexpr const char* scene_format = "drumlin-scene-1";

template <class Visitor>
void describe(Visitor& v, PeriodicX& p) {
  v.value("x_min_mm", p.x_min_mm, required("mm", coordinate_mm(), "Left end of the domain."));
  v.value("x_max_mm", p.x_max_mm, required("mm", coordinate_mm(), "Right end."));
}

template <class Visitor>
void describe(Visitor& v, PeriodicZ& p) {
  v.value("z_min_mm", p.z_min_mm, required("mm", coordinate_mm(), "Lower end of the cell."));
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
  v.variant("shape", region, "Shape of the region.", alternative<CircleRegion>("circle", "a disc."),
            alternative<RectangleRegion>("rectangle", "its sides along x and z."));
}

template <class Visitor>
void describe(Visitor& v, TwoSizes& s) {
  v.value("small_share", s.small_share, required("", at_least(0, 1), "Share of small ones, by number."));
}

template <class Visitor>
void describe(Visitor& v, PowerLawSizes& s) {
  v.value("exponent", s.exponent, required("", at_least(-20, 20), "a: numbers per diameter fall as D^-a."));
}

template <class Visitor>
void describe(Visitor& v, LognormalSizes& s) {
  v.value("median_mm", s.median_mm, required("mm", length_mm(), "Median, before the cut."));
  v.value("sigma", s.sigma, required("", above(0, 3), "Standard deviation of ln D, before the cut."));
}

template <class Visitor>
void describe(Visitor& v, std::variant<TwoSizes, PowerLawSizes, LognormalSizes>& sizes) {
  v.variant("kind", sizes, "Distribution between smallest and largest diameter.",
            alternative<TwoSizes>("two", "either the one or the other."),
            alternative<PowerLawSizes>("power_law", "a power of the diameter."),
            alternative<LognormalSizes>("lognormal", "normal in ln D, cut at both."));
}

template <class Visitor>
void describe(Visitor& v, GeneratedGrains& g) {
  v.value("count", g.count, required("", at_least(1, 1e8), "Number of grains."));
  v.value("diameter_min_mm", g.diameter_min_mm, required("mm", length_mm(), "Smallest diameter."));
  v.value("diameter_max_mm", g.diameter_max_mm, required("mm", length_mm(), "Largest diameter."));
  v.table("region", g.region, Need::required, "Filled from below.");
  v.optional_table("sizes", g.sizes, "Distribution of the diameters; without it uniform.");
  v.value("placement", g.placement,
          defaulted("", one_of({"apart", "deposited"}),
                    "apart: none touches another, and they fall. deposited: each falls along -z where the "
                    "surface is lowest and rolls into a hollow, so that the packing is nearly at rest."));
}

template <class Visitor>
void describe(Visitor& v, ListedGrains& g) {
  v.value("file", g.file,
          required("", not_empty(),
                   "CSV file, its path from the folder of the scene: x_mm, z_mm, diameter_mm and, if wanted, "
                   "v_x_mm_s, v_z_mm_s, spin_rad_s, density_kg_m3, material."));
}

template <class Visitor>
void describe(Visitor& v, GrainMaterial& m) {
  v.value("name", m.name, required("", not_empty(), "Name."));
  v.value("share", m.share,
          defaulted("", above(0, 1e6), "Share of the generated grains, by number, relative to the others."));
}

template <class Visitor>
void describe(Visitor& v, GrainsOfRun& g) {
  v.value("run", g.run, required("", not_empty(), "Folder of the run, from that of the scene."));
  v.value("time_s", g.time_s, when_given("s", at_least(0), "Of one of its snapshots; without, the last."));
}

template <class Visitor>
void describe(Visitor& v, GrainGroup& g) {
  v.value("name", g.name, required("", not_empty(), "Name of the group."));
  v.value("material", g.material, when_given("", not_empty(), "One of grains.materials, for all of them."));
  v.value("density_kg_m3", g.density_kg_m3,
          when_given("kg/m3", above(0, 1e6), "Density of a disc; without, grains.density_kg_m3."));
  v.one_table_of(g.source, "Where the grains of the group come from.",
                 alternative<GeneratedGrains>("generated", "Made from a distribution."),
                 alternative<ListedGrains>("listed", "Listed one by one."));
}

template <class Visitor>
void describe(Visitor& v, Grains& g) {
  v.value("density_kg_m3", g.density_kg_m3, required("kg/m3", above(0, 1e6), "Density of a disc."));
  v.tables("materials", g.materials, 0, "For laws that differ from pair to pair.");
  v.one_table_of(g.source, "Where the grains come from.",
                 alternative<GeneratedGrains>("generated", "Made from a distribution."),
                 alternative<ListedGrains>("listed", "Listed one by one."),
                 alternative<GrainsOfRun>("from_run", "A snapshot of another run."));
  v.value("thermal_speed_mm_s", g.thermal_speed_mm_s,
          when_given(
              "mm/s", above(0, 1e9),
              "Adds Maxwell's velocities at the start: no momentum, the energy of all mass at this speed."));
  v.tables("groups", g.groups, 0, "More grains, behind the others.");
}

template <class Visitor>
void describe(Visitor& v, ContainerShape& c) {
  v.value("center_mm", c.center_mm, defaulted("mm", coordinate_mm(), "Centre [x, z]."));
  v.value("radius_mm", c.radius_mm, required("mm", length_mm(), "Inner radius."));
}

template <class Visitor>
void describe(Visitor& v, SegmentShape& s) {
  v.value("from_mm", s.from_mm, required("mm", coordinate_mm(), "One end [x, z]."));
  v.value("to_mm", s.to_mm, required("mm", coordinate_mm(), "Its other end [x, z]."));
}

template <class Visitor>
void describe(Visitor& v, DiscShape& d) {
  v.value("center_mm", d.center_mm, required("mm", coordinate_mm(), "Centre [x, z]."));
  v.value("diameter_mm", d.diameter_mm, required("mm", length_mm(), "Diameter of the disc."));
}

template <class Visitor>
void describe(Visitor& v, PolylineShape& p) {
  v.value("x_mm", p.x_mm, required("mm", coordinate_mm(), "The points' x, in their order."));
  v.value("z_mm", p.z_mm, required("mm", coordinate_mm(), "The points' z, as many."));
  v.value("closed", p.closed,
          when_given("", anything(), "A line leads from the last point back to the first."));
}

template <class Visitor>
void describe(Visitor& v, ArcShape& a) {
  v.value("center_mm", a.center_mm, required("mm", coordinate_mm(), "Centre [x, z] of the arc's circle."));
  v.value("radius_mm", a.radius_mm, required("mm", length_mm(), "Its radius."));
  v.value("from_deg", a.from_deg,
          required("deg", at_least(-360, 360), "Where the arc begins, from +x anticlockwise as drawn."));
  v.value("to_deg", a.to_deg,
          required("deg", at_least(-360, 720), "Where it ends: above from_deg, by less than 360."));
}

template <class Visitor>
void describe(Visitor& v, Roughness& r) {
  v.value("diameter_mm", r.diameter_mm, required("mm", length_mm(), "Diameter of the glued discs."));
  v.value(
      "spacing_mm", r.spacing_mm,
      required("mm", length_mm(), "Of their centres along the wall; shortened so that a whole number fits."));
}

template <class Visitor>
void describe(Visitor& v, Wall& w) {
  v.value("name", w.name, required("", not_empty(), "Shapes of one name move together."));
  v.variant("shape", w.shape, "Shape of the wall.",
            alternative<ContainerShape>("container", "a circle with the grains inside it."),
            alternative<SegmentShape>("segment", "a straight line, solid on both sides."),
            alternative<DiscShape>("disc", "a disc that is part of the wall."),
            alternative<PolylineShape>("polyline", "straight lines, solid on both sides."),
            alternative<ArcShape>("arc", "a piece of a circle, solid on both sides."));
  v.value("material", w.material, when_given("", not_empty(), "Its material."));
  v.optional_table("rough", w.rough, "Discs glued along a container or a segment.");
}

template <class Visitor>
void describe(Visitor& v, Effects& e) {
  v.optional_table("gravity", e.gravity, "Uniform gravity.");
  v.optional_table("friction", e.friction, "Coulomb friction; costs one unknown more per contact.");
  v.optional_table("restitution", e.restitution, "Newton restitution of the normal velocity.");
  v.optional_table("spin", e.spin, "Angular velocity of the grains; needs friction.");
  v.optional_table("rolling_resistance", e.rolling_resistance,
                   "A couple that opposes rolling; costs one unknown more per contact, needs spin.");
  v.optional_table("cohesion", e.cohesion,
                   "Constant attraction of surfaces that touch; counts as load in Coulomb's law.");
  v.optional_table("rotating_frame", e.rotating_frame,
                   "The scene is told in a frame that turns; gravity keeps its direction in the laboratory.");
}

template <class Visitor>
void describe(Visitor& v, SolverSettings& s) {
  v.value("name", s.name, defaulted("", one_of(contact_solver_names()), "Contact solver."));
  v.value("tolerance", s.tolerance,
          defaulted("", above(0, 10), "The solver may stop below this residual (docs/conventions.md)."));
  v.value("penetration_tolerance", s.penetration_tolerance,
          defaulted("d", above(0, 1e3), "... and below this predicted penetration and sinking per step."));
  v.value("max_sweeps", s.max_sweeps, defaulted("", at_least(1, 1e7), "It stops after so many in any case."));
  v.value("check_every", s.check_every,
          defaulted("", at_least(1, 1e7), "Sweeps between two looks at the residual."));
  v.value("projection_sweeps", s.projection_sweeps,
          defaulted("", at_least(0, 1e6), "Sweeps that remove overlaps from positions; 0: none."));
  v.value("stop_when_unconverged", s.stop_when_unconverged,
          defaulted("", anything(), "End with exit code 3 at the first step that misses the tolerances."));
  v.value(
      "capture_unconverged", s.capture_unconverged,
      defaulted(
          "", at_least(0, 1e6),
          "Of the first so many steps that miss the tolerances the contact problems are left in problems/."));
  v.value(
      "allow_crushing", s.allow_crushing,
      when_given("", anything(),
                 "No end with exit code 3 where loaded contacts overlap by more than 0.2 d in the mean."));
}

template <class Visitor>
void describe(Visitor& v, Output& o) {
  v.value(
      "velocity_window_s", o.velocity_window_s,
      defaulted("s", at_least(0), "Displacements over this window are stored with each snapshot; 0: none."));
  v.value("log_every_steps", o.log_every_steps,
          defaulted("", at_least(1, 1e9), "Steps between two lines of the log."));
  v.value("checkpoint_every_s", o.checkpoint_every_s,
          defaulted("s", above(0), "Simulated time between two checkpoints."));
  v.value("energy_ledger", o.energy_ledger, defaulted("", anything(), "Leaves energy.csv."));
  v.value("walls_every_s", o.walls_every_s,
          when_given("s", above(0), "Leaves walls.csv: means over intervals of so much simulated time."));
}

template <class Visitor>
void describe(Visitor& v, Scene& s) {
  v.format(scene_format);
  v.value("title", s.title, defaulted("", title_line(), "Title, for reports."));
  v.value("reduced", s.reduced,
          defaulted("", anything(), "Says \"reduced\" on every output: a trial, no result."));
  v.value("seed", s.seed, defaulted("", at_least(0), "Of all random numbers."));
  v.optional_table("periodic_x", s.periodic_x, "Periodic domain in x; a scene without it is open.");
  v.table("grains", s.grains, Need::required, "The grains.");
  v.tables("walls", s.walls, 0, "The walls, one table per shape.");
  v.table("effects", s.effects, Need::defaulted, "An effect acts if its table is present.");
  v.tables("stages", s.stages, 1, "One after the other.");
  v.table("solver", s.solver, Need::defaulted, "Contact solver and when it may stop.");
  v.table("output", s.output, Need::defaulted, "What is written, and how often.");
  v.tables("outlets", s.outlets, 0, "Regions in which grains are taken away and counted.");
  v.tables("sources", s.sources, 0, "Regions in which grains are poured.");
  v.optional_table("periodic_z", s.periodic_z,
                   "With periodic_x: a cell periodic in z too, without walls and gravity.");
}

}  // namespace drumlin::particles
