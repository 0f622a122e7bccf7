#include "apps/flow/flow_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/flow/flow_accuracy.hpp"
#include "apps/flow/flow_sensitivity.hpp"
#include "apps/flow/flow_state_file.hpp"
#include "apps/flow/law_band.hpp"
#include "apps/support/figures.hpp"
#include "apps/support/json_file.hpp"
#include "continuum/rheology/ill_posed_ranges.hpp"
#include "coupling/exchange/text_file.hpp"
#include "coupling/files/field_map_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

ProfileSet profiles_with_header(const FinishedFlow& flow) {
  ProfileSet profiles = flow.flow_case.profiles(flow.solution.field);
  profiles.header = {{"side", "continuum"},
                     {"title", flow.scene.title},
                     {"geometry", flow.flow_case.geometry},
                     {"reduced", flow.reduced ? "true" : "false"},
                     {"position", "0"},
                     {"layer_thickness", fmt::format("{}", flow.scene.output.layer_thickness)},
                     {"diameter_m", fmt::format("{}", scales_of(flow.scene).length_m)},
                     {"revision", provenance().revision}};
  for (const auto& [key, value] : flow.flow_case.profile_header(flow.solution.field))
    profiles.header[key] = value;
  add_band(flow.law_band, profiles);
  return profiles;
}

FieldMap maps_with_header(const FinishedFlow& flow, const ProfileSet& profiles) {
  FieldMap maps = flow_map(flow.solution.field, flow.flow_case.map_area(flow.solution.field),
                           flow.scene.output.map_spacing);
  maps.scales = scales_of(flow.scene);
  maps.header.insert(profiles.header.begin(), profiles.header.end());
  add_band(flow.law_band, maps);
  // What belongs to the slice of the profiles alone.
  for (const char* key : {"position", "slice_width", "layer_thickness", "wall_z"}) maps.header.erase(key);
  return maps;
}

Json meshes_json(const std::vector<MeshResult>& meshes) {
  Json list = Json::array();
  for (const MeshResult& mesh : meshes) {
    Json entry{{"cells", mesh.cells}, {"unknowns", mesh.unknowns}};
    add_scalars(entry, mesh.scalars);
    list.push_back(std::move(entry));
  }
  return list;
}

// What the last halving of the cells changed: an upper estimate of what remains, as long as the changes
// shrink.
Json mesh_change(const std::vector<MeshResult>& meshes) {
  if (meshes.size() < 2) return nullptr;
  const ScalarSet &fine = meshes.back().scalars, &coarse = meshes[meshes.size() - 2].scalars;
  Json changes;
  for (const Scalar& scalar : fine.scalars)
    changes[scalar.name] =
        to_json(Scalar{scalar.name, std::abs(scalar.value - coarse.value(scalar.name)), {}});
  return changes;
}

// null where the order does not allow.
Json mesh_limit_json(const std::vector<MeshResult>& meshes) {
  if (meshes.size() < 3) return nullptr;
  Json content = Json::object();
  for (const ScalarLimit& s : limits_of(meshes))
    if (s.limit)
      content[s.name] = {{"order", s.limit->order}, {"value", s.limit->value}};
    else
      content[s.name] = nullptr;
  return content;
}

// Why there is no mesh_change: null says that nothing was computed, not that nothing changed.
Json mesh_change_missing(const FinishedFlow& flow) {
  if (flow.meshes.size() > 1) return nullptr;
  if (flow.scene.time) return "a march stays on one mesh";
  if (flow.scene.mesh.levels == 1) return "the scene has one mesh";
  return "started on the last mesh from another flow: no coarser one was solved";
}

Json scalars_json(const ScalarSet& scalars) {
  Json object = Json::object();
  add_scalars(object, scalars);
  return object;
}

Json closed_form_json(const FinishedFlow& flow) {
  if (!flow.findings.closed_form) return nullptr;
  const GapComparison& c = *flow.findings.closed_form;
  return {{"mesh_error", c.mesh_error},
          {"mesh_error_max", c.mesh_error_max},
          {"closed_form_error", c.closed_form_error},
          {"closed_form_error_max", c.closed_form_error_max},
          {"scalars", scalars_json(c.closed_form)},
          {"profile", {{"z", c.z}, {"v_x", c.v_x}, {"v_x_closed_form", c.v_x_closed_form}}}};
}

Json plain_json(const FinishedFlow& flow) {
  Json change;
  for (const Scalar& scalar : flow.plain->scalars.scalars)
    change[scalar.name] =
        to_json(Scalar{scalar.name, scalar.value - flow.meshes.back().scalars.value(scalar.name), {}});
  return {{"scalars", scalars_json(flow.plain->scalars)},
          {"change", change},
          {"v_x_change", flow.plain->v_x_change},
          {"profile", {{"z", flow.plain->profiles.z}, {"v_x", flow.plain->profiles.column("v_x").value}}},
          {"turns", flow.solution.report.turns},
          {"turn_change", flow.solution.report.turn_change}};
}

Json ill_posed_json(const FlowProblem& problem) {
  Json ranges = Json::array();
  for (const InertialRange& range :
       ill_posed_ranges(problem.law, problem.turned ? &problem.turned->k : nullptr))
    ranges.push_back({range.from, range.to});
  return ranges;
}

// The keys of rheology.toml; those of the logarithm come without their "law", as before there were others.
Json friction_json(const MeasuredFriction& mu) {
  struct Keys {
    Json operator()(const LogFriction& m) const {
      return {{"a", m.a}, {"b", m.b}, {"I_min", m.I_min}, {"I_max", m.I_max}};
    }
    Json operator()(const LogLinearFriction& m) const {
      return {{"law", "log-linear"}, {"a", m.a},        {"b", m.b}, {"c", m.c},
              {"I_min", m.I_min},    {"I_max", m.I_max}};
    }
    Json operator()(const ConstantFriction& m) const { return {{"law", "constant"}, {"mu", m.mu}}; }
    Json operator()(const JopFriction& m) const {
      return {{"law", "jop"}, {"mu_s", m.mu_s}, {"mu_2", m.mu_2}, {"I_0", m.I_0}};
    }
    Json operator()(const FrictionTable& m) const { return {{"law", "table"}, {"I", m.I}, {"mu", m.mu}}; }
  };
  return std::visit(Keys{}, mu);
}

Json settings_json(const FinishedFlow& flow) {
  const FlowScene& s = flow.scene;
  Json law = friction_json(flow.law.mu);
  law["nu"] = flow.law.nu;
  law["fitted_on"] = flow.law.fitted_on;
  if (flow.law.k) law["k"] = {{"I", flow.law.k->I}, {"k", flow.law.k->k}};
  Json settings{{"title", s.title}, {"law", law}};
  add_scalars(settings, flow.flow_case.settings);
  const Json rest{{"surface_cell", s.mesh.surface_cell},
                  {"surface_zone", s.mesh.surface_zone},
                  {"levels", s.mesh.levels},
                  {"regularisation_shear_rate", s.regularisation.shear_rate},
                  {"regularisation_pressure", s.regularisation.pressure},
                  {"tolerance", s.solver.tolerance},
                  {"layer_thickness", s.output.layer_thickness},
                  {"scales", to_json(scales_of(s))}};
  settings.update(rest);
  return settings;
}

Json phases_json(const FlowReport& report) {
  Json phases;
  for (const PhaseSeconds& phase : report.phases)
    phases[phase.name] = {{"seconds", phase.seconds}, {"times", phase.times}};
  return phases;
}

// How large that is which the scene leaves out, where it is left out.
Json left_out_json(const FinishedFlow& flow) {
  const LeftOut& rest = *flow.findings.left_out;
  const FlowEffects& effects = flow.scene.effects;
  Json content = Json::object();
  if (!has_inertia(flow.scene)) {
    content["inertia_rms"] = rest.inertia_rms;
    content["inertia_largest"] = rest.inertia_largest;
  }
  if (!effects.moving_surface) content["surface_height_rms"] = rest.surface_height_rms;
  if (!effects.wall_slip) content["wall_above_friction_0.95"] = rest.wall_friction;
  if (!effects.nonlocal && rest.nonlocal) content["nonlocal_1_d_rms"] = *rest.nonlocal;
  if (!effects.fabric && rest.fabric) content["fabric_c_1_rms"] = *rest.fabric;
  return content;
}

// Where the surface has gone, and what still presses on it.
Json surface_json(const FinishedFlow& flow) {
  const auto& shape = flow.solution.field.surface();
  if (!shape) return nullptr;
  std::vector<double> x, z;
  constexpr int points = 101;
  for (int i = 0; i < points; ++i) {
    const Vec2 p = surface_point(*shape, -1 + 2.0 * i / (points - 1));
    x.push_back(p.x);
    z.push_back(p.z);
  }
  Json slopes = Json::object();
  for (const double length : {10.0, 20.0, 30.0})
    slopes[fmt::format("{:g}", length)] =
        (flow.solution.field.theta() + mean_slope(*shape, length)) * 180 / std::numbers::pi;
  Json steps = Json::array();
  for (const SurfaceStepReport& step : flow.solution.report.surface_steps)
    steps.push_back({{"mesh", step.level},
                     {"share", step.share},
                     {"height", step.height},
                     {"pressed_rms", step.rms},
                     {"pressed_resolved", step.resolved},
                     {"pressed_largest", step.largest},
                     {"iterations", step.iterations}});
  return {{"x", x}, {"z", z}, {"z_middle", height(*shape, 0)}, {"slope_deg", slopes}, {"steps", steps}};
}

Json sensitivity_json(const FinishedFlow& flow) {
  if (flow.sensitivities.empty()) return nullptr;
  Json list = Json::array();
  for (const Sensitivity& s : flow.sensitivities) {
    Json entry{{"setting", s.setting}, {"found", s.found}, {"iterations", s.iterations}};
    entry["profile"] = to_json(Scalar{"profile", s.found ? s.profile : std::nan(""), {}});
    Json changes = Json::object();
    if (s.found) add_scalars(changes, s.changes);
    entry["changes"] = changes;
    entry["cpu_seconds"] = s.cpu_seconds;
    list.push_back(std::move(entry));
  }
  return list;
}

Json law_band_json(const FinishedFlow& flow) {
  const LawBand& band = flow.law_band;
  if (band.draws == 0) return nullptr;
  Json content{{"draws", band.draws},
               {"found", band.found},
               {"iterations", band.iterations},
               {"seconds", band.seconds}};
  content["profile"] = to_json(Scalar{"profile", band.profile, {}});
  content["scalars"] = scalars_json(band.scalars);
  return content;
}

Json flow_json(const FinishedFlow& flow) {
  const MeshResult& result = flow.meshes.back();
  const FlowReport& report = flow.solution.report;
  const FlowIntegrals& sums = flow.findings.sums;
  Json content{{"format", "drumlin-flow-run-1"}, {"reduced", flow.reduced}};
  content["geometry"] = flow.flow_case.geometry;
  add_scalars(content, result.scalars);
  add_scalars(content, flow.flow_case.given);
  content["ill_posed_share"] = sums.ill_posed_area / sums.area;
  content["ill_posed_I"] = ill_posed_json(flow.flow_case.problem);
  if (flow.plain) content[flow.law.k ? "without_k" : "without_nonlocal"] = plain_json(flow);
  content["unknowns"] = result.unknowns;
  content["iterations"] = report.iterations;
  content["start"] = report.start;
  if (flow.scene.time)
    content["time"] = {{"step_s", flow.scene.time->step_s},
                       {"steps", flow.scene.time->steps},
                       {"end_s", flow.scene.time->steps * flow.scene.time->step_s},
                       {"ramp_s", flow.scene.time->ramp_s}};
  content["residual"] = report.residual;
  content["seconds"] = report.seconds;
  content["cpu_seconds"] = flow.cpu_seconds;
  content["ranks"] = flow.ranks;
  content["phases"] = phases_json(report);
  content["checks"] = scalars_json(flow.findings.checks);
  if (flow.findings.left_out) content["left_out"] = left_out_json(flow);
  content["closed_form"] = closed_form_json(flow);
  content["surface"] = surface_json(flow);
  content["meshes"] = meshes_json(flow.meshes);
  content["mesh_change"] = mesh_change(flow.meshes);
  content["mesh_change_missing"] = mesh_change_missing(flow);
  content["mesh_limit"] = mesh_limit_json(flow.meshes);
  content["sensitivity"] = sensitivity_json(flow);
  content["law_band"] = law_band_json(flow);
  content["accuracy"] = accuracy_json(flow);
  content["settings"] = settings_json(flow);
  content["provenance"] = to_json(provenance());
  return content;
}

}  // namespace

std::vector<ScalarLimit> limits_of(const std::vector<MeshResult>& meshes) {
  std::vector<ScalarLimit> list;
  for (const Scalar& scalar : meshes.back().scalars.scalars) {
    std::vector<double> values;
    for (const MeshResult& mesh : meshes) values.push_back(mesh.scalars.value(scalar.name));
    list.push_back({scalar.name, mesh_limit(values)});
  }
  return list;
}

double v_x_change(const ProfileSet& without, const ProfileSet& with) {
  const auto &a = without.column("v_x").value, &b = with.column("v_x").value;
  double change = 0, size = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
    change += (a[i] - b[i]) * (a[i] - b[i]);
    size += b[i] * b[i];
  }
  return std::sqrt(change / size);
}

FlowFindings findings_of(const FlowCase& flow_case, const FlowField& field) {
  FlowFindings findings{.sums = field.integrals(), .checks = flow_case.checks(field)};
  if (flow_case.closed_form) findings.closed_form = flow_case.closed_form(field);
  if (flow_case.geometry == "drum") findings.left_out = left_out(field);
  return findings;
}

void write_iterations(const fs::path& file, const FlowReport& report) {
  std::string text = fmt::format("# drumlin-flow-iterations-2\n# converged = {}\n", report.converged);
  if (!report.failure.empty()) text += fmt::format("# failure = {}\n", report.failure);
  text +=
      "mesh,phase,shear_rate,iteration,residual,step_length,step_size,linear_residual,theta_"
      "deg,seconds\n";
  for (const IterationReport& line : report.history)
    fmt::format_to(std::back_inserter(text), "{},{},{:.4g},{},{:.4e},{:.4g},{:.4e},{:.2e},{:.6f},{:.2f}\n",
                   line.level, line.phase, line.shear_rate, line.iteration, line.residual, line.step_length,
                   line.step_size, line.linear_residual, line.theta * 180 / std::numbers::pi, line.seconds);
  replace_file(file, text);
}

void write_flow(const fs::path& folder, const FinishedFlow& flow) {
  const ProfileSet profiles = profiles_with_header(flow);
  const FieldMap maps = maps_with_header(flow, profiles);
  flow.solution.field.write_vtu(folder / "flow.vtu");
  const Json content = flow_json(flow);
  const FlowState state = flow.solution.field.state();
  if (!flow.solution.field.on_first_rank()) return;
  write_profiles(folder / "profiles.csv", profiles);
  write_field_map(folder / "maps.h5", maps);
  write_flow_state(folder / "state.h5", state);
  // The figures read it under another name: flow.json itself says that all is there.
  const fs::path unfinished = folder / "flow.json.part";
  write_json(unfinished, content);
  if (flow.scene.output.figures)
    draw_figures("flow_figures.py", {folder.string(), "--flow", unfinished.string()});
  write_json(folder / "flow.json", content);
  fs::remove(unfinished);
}

}  // namespace drumlin::apps
