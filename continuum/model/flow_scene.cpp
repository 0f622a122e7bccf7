#include "continuum/model/flow_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <utility>

#include "continuum/model/flow_region_keys.hpp"

namespace drumlin::continuum {

template <class Visitor>
void describe(Visitor& v, FlowDrum& d) {
  v.value("diameter_mm", d.diameter_mm, required("mm", above(0, 1e6), "Inner diameter."));
  v.value("rotation_rpm", d.rotation_rpm, required("rpm", above(0, 1e4), "The flow runs towards +x."));
  v.value("slope_deg", d.slope_deg, when_given("deg", above(0, 89), "Prescribed; absent: found."));
}
template <class Visitor>
void describe(Visitor& v, FlowIncline& i) {
  v.value("height_mm", i.height_mm, required("mm", above(0, 1e6), "Of the layer."));
  v.value("slope_deg", i.slope_deg, required("deg", above(0, 89), "Of the plane."));
}
template <class Visitor>
void describe(Visitor& v, FlowPlaneShear& p) {
  v.value("gap_mm", p.gap_mm, required("mm", above(0, 1e6), "Between the plates."));
  v.value("wall_speed_mm_s", p.wall_speed_mm_s, required("mm/s", above(0, 1e6), "Of the upper plate."));
  v.value("pressure_pa", p.pressure_pa, required("Pa", above(0, 1e9), "Of the upper plate."));
}
template <class Visitor>
void describe(Visitor& v, FlowChute& c) {
  v.value("half_width_mm", c.half_width_mm, required("mm", above(0, 1e6), "Half the gap."));
  v.value("pressure_pa", c.pressure_pa, required("Pa", above(0, 1e9), "Of the walls."));
}
template <class Visitor>
void describe(Visitor& v, FlowAnnulus& a) {
  v.value("inner_radius_mm", a.inner_radius_mm, required("mm", above(0, 1e6), "Radius."));
  v.value("outer_radius_mm", a.outer_radius_mm, required("mm", above(0, 1e6), "Radius."));
  v.value("rotation_rpm", a.rotation_rpm, required("rpm", above(0, 1e4), "Of the inner cylinder."));
  v.value("pressure_pa", a.pressure_pa, required("Pa", above(0, 1e9), "Of the outer cylinder."));
}
template <class Visitor>
void describe(Visitor& v, FlowGrains& g) {
  v.value("count", g.count,
          when_given("", at_least(1, 1e9), "Number of discs, the fill of a drum; elsewhere refused."));
  v.value("diameter_min_mm", g.diameter_min_mm, required("mm", above(0, 1e6), "Smallest diameter."));
  v.value("diameter_max_mm", g.diameter_max_mm, required("mm", above(0, 1e6), "Largest; uniform between."));
  v.value("density_kg_m3", g.density_kg_m3, required("kg/m3", above(0, 1e6), "Density of a disc."));
}
template <class Visitor>
void describe(Visitor& v, FlowGravity& g) {
  v.value("acceleration_m_s2", g.acceleration_m_s2,
          defaulted("m/s2", above(0, 1e4), "Part of the units even without weight."));
  v.value("direction_deg", g.direction_deg,
          when_given("deg", at_least(-360, 360),
                     "Of a region, anticlockwise from +x; absent: -90, down. Elsewhere refused."));
}
template <class Visitor>
void describe(Visitor& v, FlowMesh& m) {
  v.value("surface_cell", m.surface_cell,
          defaulted("d", at_least(0.005, 100),
                    "Largest cell near surface, driven wall or chute wall, finest mesh."));
  v.value("surface_zone", m.surface_zone,
          defaulted("d", at_least(0, 1e4), "Up to this distance from there."));
  v.value("growth", m.growth,
          defaulted("", at_least(0, 1), "Growth of cells per distance beyond, coarsest mesh."));
  v.value("levels", m.levels, defaulted("", at_least(1, 5), "Meshes, each twice as fine."));
  v.value("refined_share", m.refined_share,
          defaulted("", above(0, 1),
                    "Share of cells that a finer mesh halves, by jumps of the velocity gradient."));
}
template <class Visitor>
void describe(Visitor& v, FlowBoundary& b) {
  v.value("entrainment_length", b.entrainment_length,
          defaulted("d", above(0, 100), "At s from the surface the wall's material lags by exp(-s/length)."));
  v.value("surface_stiffness", b.surface_stiffness,
          defaulted("rho0 g", above(0, 1e8), "T_nn = -stiffness u_n."));
}
template <class Visitor>
void describe(Visitor& v, FlowRegularisation& r) {
  v.value("shear_rate", r.shear_rate,
          defaulted("sqrt(g/d)", above(0, 1), "eps: |D| becomes sqrt(|D|^2 + eps^2/4)."));
  v.value("pressure", r.pressure,
          defaulted("rho0 g d", above(0, 10), "p_min: the law's p becomes (p + sqrt(p^2 + 4 p_min^2))/2."));
}
template <class Visitor>
void describe(Visitor& v, FlowSolverKeys& s) {
  v.value("tolerance", s.tolerance, defaulted("", above(0, 1), "Nonlinear residual over the weight's norm."));
  v.value("linear_tolerance", s.linear_tolerance,
          defaulted("", above(0, 1), "True relative residual of linear solves."));
  v.value("max_iterations", s.max_iterations, defaulted("", at_least(1, 10000), "Newton, per phase."));
  v.value("sensitivity", s.sensitivity,
          defaulted("", anything(), "Solves again with eps / 4, p_min - 20 %, one more iteration."));
}
template <class Visitor>
void describe(Visitor&, FlowInertia&) {}
template <class Visitor>
void describe(Visitor&, FlowRotatingFrame&) {}
template <class Visitor>
void describe(Visitor& v, FlowWallSlip& s) {
  v.value("friction", s.friction, required("", above(0, 2), "Of the wall against the grains."));
  v.value("slip_speed", s.slip_speed,
          defaulted("sqrt(g d)", above(0, 1), "Speed at which friction is nearly full."));
}
template <class Visitor>
void describe(Visitor&, FlowMemory&) {}
template <class Visitor>
void describe(Visitor& v, FlowNonlocal& n) {
  v.value("length", n.length, when_given("d", above(0, 1000), "Law without threshold."));
  v.value("amplitude", n.amplitude, when_given("d", above(0, 100), "A of a length A/sqrt(abs(mu - mu_s))."));
  v.value("threshold", n.threshold, when_given("", above(0, 2), "mu_s; absent: the law's."));
}
template <class Visitor>
void describe(Visitor& v, FlowMovingSurface& m) {
  v.value("degree", m.degree,
          when_given("", at_least(4, 60),
                     "Of its polynomial; absent: resolves 0.8 of the finest cell at the ends."));
  v.value("tolerance", m.tolerance, defaulted("d", above(0, 1), "Rms of what presses on it, as a height."));
}
template <class Visitor>
void describe(Visitor& v, FlowEffects& e) {
  v.optional_table("inertia", e.inertia, "nu u.grad u in the balance of momentum.");
  v.optional_table("rotating_frame", e.rotating_frame, "Velocities seen from the drum; no answer changes.");
  v.optional_table("wall_slip", e.wall_slip, "Sliding along the wall.");
  v.optional_table("memory", e.memory, "Memory of the axes, by the law's [memory].");
  v.optional_table("nonlocal", e.nonlocal,
                   "g - length^2 lap g = g_loc, or amplitude^2 lap g/g = mu(I) - mu.");
  v.optional_table("moving_surface", e.moving_surface, "The surface goes where nothing presses on it.");
}
template <class Visitor>
void describe(Visitor& v, FlowTime& t) {
  v.value("step_s", t.step_s, required("s", above(0, 1e6), "Step."));
  v.value("steps", t.steps, required("", at_least(1, 1e6), "Number of steps."));
  v.value("ramp_s", t.ramp_s,
          defaulted("s", at_least(0, 1e9), "Linear change of the drum's speed from the start's."));
  v.value("every", t.every, defaulted("", at_least(1, 1e6), "Steps from one kept state to the next."));
}
template <class Visitor>
void describe(Visitor& v, FlowOutput& o) {
  v.value("slice_width", o.slice_width,
          when_given("d", above(0, 1e4),
                     "Of a drum's profiles; absent: 20, at most a quarter of the chord. Elsewhere refused."));
  v.value("layer_thickness", o.layer_thickness, defaulted("d", at_least(1e-3, 100), "Thickness."));
  v.value("map_spacing", o.map_spacing, defaulted("d", at_least(1e-3, 100), "Of maps.h5."));
  v.value("figures", o.figures, defaulted("", anything(), "Draws figures."));
}
template <class Visitor>
void describe(Visitor& v, FlowScene& s) {
  v.format("drumlin-flow-scene-1");
  v.value("title", s.title, defaulted("", title_line(), "For reports."));
  v.value("reduced", s.reduced, defaulted("", anything(), "Marks every output as a trial."));
  v.one_table_of(s.geometry, "Geometry:", alternative<FlowDrum>("drum", "drum."),
                 alternative<FlowIncline>("incline", "layer on a plane."),
                 alternative<FlowPlaneShear>("plane_shear", "between plates."),
                 alternative<FlowChute>("chute", "between upright walls."),
                 alternative<FlowAnnulus>("annulus", "between cylinders."),
                 alternative<FlowRegion>("region", "walls and what they hold, in time."));
  v.table("grains", s.grains, Need::required, "The grains.");
  v.table("gravity", s.gravity, Need::defaulted, "Gravity.");
  const auto of_region = [&](auto own, auto others) {
    v.template with_table<FlowRegion>(s.geometry, "region", own, others);
  };
  of_region(
      [&](FlowRegion& r) {
        v.tables("walls", r.walls, 1, "One table per shape.");
        v.tables("openings", r.openings, 0, "Material leaves through them.");
        v.table("mesh", r.mesh, Need::defaulted, "Mesh of the material.");
      },
      [&] { v.table("mesh", s.mesh, Need::defaulted, "Meshes."); });
  v.optional_table("boundary", s.boundary, "Of a drum; elsewhere refused.");
  v.table("effects", s.effects, Need::defaulted, "Of a drum alone.");
  of_region([&](FlowRegion& r) { v.table("time", r.time, Need::required, "Steps in time."); },
            [&] { v.optional_table("time", s.time, "Steps of a drum; absent: steady flow."); });
  v.table("regularisation", s.regularisation, Need::defaulted, "Smoothing of the law.");
  v.table("solver", s.solver, Need::defaulted, "Newton solver.");
  of_region([&](FlowRegion& r) { v.table("output", r.output, Need::defaulted, "Frames."); },
            [&] { v.table("output", s.output, Need::defaulted, "Profiles and maps."); });
}

namespace {

// What only one geometry can make sense of is refused in the others: it would be read and mean nothing.
void check_drum(const Document& document, FlowScene& scene, std::vector<InputProblem>& problems) {
  const auto& drum = std::get<FlowDrum>(scene.geometry);
  if (!scene.grains.count)
    problems.push_back(
        problem_at(document, "grains.count", "is missing; it gives the fill of the drum", "1 to 1000000000"));
  if (scene.grains.diameter_max_mm > drum.diameter_mm)
    problems.push_back(
        problem_at(document, "grains.diameter_max_mm", "is larger than the drum", "<= drum.diameter_mm"));
  if (scene.time && scene.time->ramp_s > scene.time->steps * scene.time->step_s * (1 + 1e-12))
    problems.push_back(
        problem_at(document, "time.ramp_s", "goes on after the last step", "<= time.steps time.step_s"));
  const auto refuse_in_time = [&](bool named, const char* path) {
    if (scene.time && named)
      problems.push_back(problem_at(document, path, "is one of the steady flow", "absent with [time]"));
  };
  refuse_in_time(scene.effects.rotating_frame.has_value(), "effects.rotating_frame");
  refuse_in_time(scene.effects.memory.has_value(), "effects.memory");
  refuse_in_time(scene.effects.nonlocal.has_value(), "effects.nonlocal");
  refuse_in_time(scene.effects.moving_surface.has_value(), "effects.moving_surface");
  if (const auto& spread = scene.effects.nonlocal; spread && spread->length) {
    const auto refuse_beside_length = [&](bool named, const char* path) {
      if (named)
        problems.push_back(problem_at(document, path, "belongs to another law than effects.nonlocal.length",
                                      "absent with effects.nonlocal.length"));
    };
    refuse_beside_length(spread->amplitude.has_value(), "effects.nonlocal.amplitude");
    refuse_beside_length(spread->threshold.has_value(), "effects.nonlocal.threshold");
  }
  if (scene.effects.moving_surface && drum.slope_deg)
    problems.push_back(problem_at(document, "drum.slope_deg",
                                  "leaves the axes where a surface that moves turns itself",
                                  "absent with effects.moving_surface"));
  if (!scene.boundary) scene.boundary.emplace();
  if (!scene.output.slice_width) scene.output.slice_width = 20;
}

void refuse_keys_of_the_drum(const Document& document, const FlowScene& scene,
                             std::vector<InputProblem>& problems) {
  const auto refuse = [&](const char* path) {
    problems.push_back(problem_at(document, path, "belongs to a drum", "absent without [drum]"));
  };
  if (scene.grains.count) refuse("grains.count");
  if (scene.boundary) refuse("boundary");
  if (scene.effects.inertia) refuse("effects.inertia");
  if (scene.effects.rotating_frame) refuse("effects.rotating_frame");
  if (scene.effects.wall_slip) refuse("effects.wall_slip");
  if (scene.time) refuse("time");
  if (scene.effects.memory) refuse("effects.memory");
  if (scene.effects.nonlocal) refuse("effects.nonlocal");
  if (scene.effects.moving_surface) refuse("effects.moving_surface");
  if (scene.output.slice_width) refuse("output.slice_width");
}

// What a region has of its own, or not at all.
void check_scene_of_region(const Document& document, FlowScene& scene, std::vector<InputProblem>& problems) {
  const auto& region = std::get<FlowRegion>(scene.geometry);
  check_region(document, region, problems);
  if (!scene.gravity.direction_deg) scene.gravity.direction_deg = -90;
}

// Below, p_min adds more than 10 % to the law's p: the flow would be one of p_min.
constexpr double least_pressure = 3;  // of p_min

void check_pressure(const Document& document, const FlowScene& scene, std::vector<InputProblem>& problems) {
  const double least_pa = least_pressure * scene.regularisation.pressure * scales_of(scene).stress_Pa();
  const auto check = [&](const auto* gap, const char* path) {
    if (gap && gap->pressure_pa < least_pa)
      problems.push_back(
          problem_at(document, path, fmt::format("is {:g}", gap->pressure_pa),
                     fmt::format(">= {:.3g}, {:g} times regularisation.pressure", least_pa, least_pressure)));
  };
  check(std::get_if<FlowPlaneShear>(&scene.geometry), "plane_shear.pressure_pa");
  check(std::get_if<FlowChute>(&scene.geometry), "chute.pressure_pa");
  check(std::get_if<FlowAnnulus>(&scene.geometry), "annulus.pressure_pa");
}

FlowScene scene_of(const Document& document) {
  std::vector<InputProblem> problems;
  FlowScene scene = read_keys<FlowScene>(document, problems);
  scene.title = title_with_changes(scene.title, document, {"output", "reduced", "solver.sensitivity"});
  if (problems.empty()) {
    if (scene.grains.diameter_max_mm < scene.grains.diameter_min_mm)
      problems.push_back(problem_at(document, "grains.diameter_max_mm", "is smaller than diameter_min_mm",
                                    ">= diameter_min_mm"));
    if (std::holds_alternative<FlowDrum>(scene.geometry))
      check_drum(document, scene, problems);
    else
      refuse_keys_of_the_drum(document, scene, problems);
    if (std::holds_alternative<FlowRegion>(scene.geometry))
      check_scene_of_region(document, scene, problems);
    else if (scene.gravity.direction_deg)
      problems.push_back(
          problem_at(document, "gravity.direction_deg", "belongs to a region", "absent without [region]"));
    check_pressure(document, scene, problems);
    if (const auto* ring = std::get_if<FlowAnnulus>(&scene.geometry);
        ring && ring->outer_radius_mm <= ring->inner_radius_mm)
      problems.push_back(
          problem_at(document, "annulus.outer_radius_mm", "leaves no gap", "> annulus.inner_radius_mm"));
    sort_by_place(problems);
  }
  return accepted(std::move(scene), problems);
}

}  // namespace

FlowScene read_flow_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return scene_of(read_toml(file, overrides));
}

FlowScene parse_flow_scene(const std::string& text, const std::string& name,
                           const std::vector<std::string>& overrides) {
  return scene_of(parse_toml(text, name, overrides));
}

std::string flow_scene_text(const FlowScene& scene) { return toml_text(write_keys(scene)); }

std::vector<KeyRow> flow_scene_keys() { return list_keys<FlowScene>(); }

Scales scales_of(const FlowScene& scene) {
  return drumlin::scales_of(0.5e-3 * (scene.grains.diameter_min_mm + scene.grains.diameter_max_mm),
                            scene.gravity.acceleration_m_s2, scene.grains.density_kg_m3);
}

double grain_area(const FlowGrains& grains, int count) {
  const double mean = 0.5 * (grains.diameter_min_mm + grains.diameter_max_mm);
  const double spread = (grains.diameter_max_mm - grains.diameter_min_mm) / mean;
  return count * std::numbers::pi / 4 * (1 + spread * spread / 12);
}

}  // namespace drumlin::continuum
