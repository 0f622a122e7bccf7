#include "continuum/model/flow_scene.hpp"

#include <numbers>

#include "coupling/exchange/key_table.hpp"

namespace drumlin {

template <class Visitor>
void describe(Visitor& v, FlowDrum& d) {
  v.value("diameter_mm", d.diameter_mm, required("mm", above(0, 1e6), "Inner diameter of the drum."));
  v.value("rotation_rpm", d.rotation_rpm,
          required("rpm", above(0, 1e4), "Speed of rotation; the flow runs towards +x."));
}
template <class Visitor>
void describe(Visitor& v, FlowGrains& g) {
  v.value(
      "count", g.count,
      required("", at_least(1, 1e9), "Number of discs; with their diameters and the law's nu, the fill."));
  v.value("diameter_min_mm", g.diameter_min_mm, required("mm", above(0, 1e6), "Smallest diameter."));
  v.value("diameter_max_mm", g.diameter_max_mm,
          required("mm", above(0, 1e6), "Largest diameter; diameters are uniform between."));
  v.value("density_kg_m3", g.density_kg_m3, required("kg/m3", above(0, 1e6), "Density of a disc."));
}
template <class Visitor>
void describe(Visitor& v, FlowGravity& g) {
  v.value("acceleration_m_s2", g.acceleration_m_s2, defaulted("m/s2", above(0, 1e4), "Strength of gravity."));
}
template <class Visitor>
void describe(Visitor& v, FlowMesh& m) {
  v.value("surface_cell", m.surface_cell,
          defaulted("d", above(0, 100), "Largest cell near the surface, on the finest mesh."));
  v.value("surface_zone", m.surface_zone,
          defaulted("d", at_least(0, 1e4), "Depth down to which cells keep that size."));
  v.value("growth", m.growth,
          defaulted("", at_least(0, 1), "Growth of the cell size per unit of depth below, coarsest mesh."));
  v.value("levels", m.levels,
          defaulted("", at_least(1, 5),
                    "Meshes, each twice as fine; the errors in flow.json compare the last two."));
}
template <class Visitor>
void describe(Visitor& v, FlowBoundary& b) {
  v.value("corner_taper", b.corner_taper,
          defaulted("d", above(0, 100),
                    "Distance from the ends of the surface over which the wall's speed rises from nought."));
  v.value(
      "surface_stiffness", b.surface_stiffness,
      defaulted("rho0 g", above(0, 1e8), "T_nn = -stiffness u_n at the surface; large: nothing passes it."));
}
template <class Visitor>
void describe(Visitor& v, FlowRegularisation& r) {
  v.value("shear_rate", r.shear_rate,
          defaulted("sqrt(g/d)", above(0, 1),
                    "eps: |D| becomes sqrt(|D|^2 + eps^2/4); slower shear counts as rigid."));
  v.value(
      "pressure", r.pressure,
      defaulted(
          "rho0 g d", above(0, 10),
          "p_min: the law's p becomes (p + sqrt(p^2 + 4 p_min^2))/2, the least strength at the surface."));
}
template <class Visitor>
void describe(Visitor& v, FlowSolverKeys& s) {
  v.value("tolerance", s.tolerance,
          defaulted("", above(0, 1), "On the nonlinear residual over the norm of the weight."));
  v.value("linear_tolerance", s.linear_tolerance,
          defaulted("", above(0, 1), "On the true relative residual of each linear solve."));
  v.value("max_iterations", s.max_iterations,
          defaulted("", at_least(1, 10000), "Newton iterations per phase."));
}
template <class Visitor>
void describe(Visitor& v, FlowOutput& o) {
  v.value(
      "slice_width", o.slice_width,
      defaulted("d", above(0, 1e4), "Width of the slice of the profiles, cut to a quarter of the chord."));
  v.value("layer_thickness", o.layer_thickness, defaulted("d", above(0, 100), "Thickness of its layers."));
  v.value("map_spacing", o.map_spacing, defaulted("d", above(0, 100), "Spacing of the points of maps.csv."));
}
template <class Visitor>
void describe(Visitor& v, FlowScene& s) {
  v.format("drumlin-flow-scene-1");
  v.value("title", s.title, defaulted("", anything(), "Title, for reports."));
  v.value("reduced", s.reduced,
          defaulted("", anything(), "Says \"reduced\" on every output: a trial, no result."));
  v.table("drum", s.drum, Need::required, "The drum.");
  v.table("grains", s.grains, Need::required, "The grains that fill it.");
  v.table("gravity", s.gravity, Need::defaulted, "Gravity.");
  v.table("mesh", s.mesh, Need::defaulted, "Finite-element meshes.");
  v.table("boundary", s.boundary, Need::defaulted, "Drum wall and free surface.");
  v.table("regularisation", s.regularisation, Need::defaulted, "Where the law is smoothed.");
  v.table("solver", s.solver, Need::defaulted, "When the solver may stop.");
  v.table("output", s.output, Need::defaulted, "Profiles and maps.");
}

namespace {

FlowScene scene_of(const Document& document) {
  std::vector<InputProblem> problems;
  FlowScene scene = read_keys<FlowScene>(document, problems);
  if (problems.empty()) {
    if (scene.grains.diameter_max_mm < scene.grains.diameter_min_mm)
      problems.push_back(problem_at(document, "grains.diameter_max_mm", "is smaller than diameter_min_mm",
                                    ">= diameter_min_mm"));
    if (scene.grains.diameter_max_mm > scene.drum.diameter_mm)
      problems.push_back(
          problem_at(document, "grains.diameter_max_mm", "is larger than the drum", "<= drum.diameter_mm"));
  }
  if (!problems.empty()) throw InputError(problems);
  return scene;
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
  return scales_of(0.5e-3 * (scene.grains.diameter_min_mm + scene.grains.diameter_max_mm),
                   scene.gravity.acceleration_m_s2, scene.grains.density_kg_m3);
}

double grain_area(const FlowGrains& grains) {
  const double mean = 0.5 * (grains.diameter_min_mm + grains.diameter_max_mm);
  const double spread = (grains.diameter_max_mm - grains.diameter_min_mm) / mean;
  return grains.count * std::numbers::pi / 4 * (1 + spread * spread / 12);
}

}  // namespace drumlin
