#include "apps/flow/flow_files.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/support/figures.hpp"
#include "apps/support/json_file.hpp"
#include "continuum/sampling/drum_profiles.hpp"
#include "coupling/exchange/text_file.hpp"

namespace drumlin::apps {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

SliceOptions slice_of(const FlowScene& scene) {
  return {scene.output.slice_width, scene.output.layer_thickness};
}

ProfileSet profiles_with_header(const FinishedFlow& flow) {
  ProfileSet profiles = drum_profiles(flow.solution.field, flow.drum, slice_of(flow.scene));
  const auto number = [](double value) { return fmt::format("{}", value); };
  profiles.header = {{"side", "continuum"},
                     {"title", flow.scene.title},
                     {"reduced", flow.reduced ? "true" : "false"},
                     {"theta_deg", number(flow.solution.field.theta() * 180 / std::numbers::pi)},
                     {"axis_depth", number(flow.drum.axis_offset)},
                     {"drum_radius", number(flow.drum.radius)},
                     {"wall_z", number(flow.drum.axis_offset - flow.drum.radius)},
                     {"rotation", number(flow.drum.rotation)},
                     {"position", "0"},
                     {"slice_width", number(slice_width(slice_of(flow.scene), flow.drum))},
                     {"layer_thickness", number(flow.scene.output.layer_thickness)},
                     {"diameter_m", number(scales_of(flow.scene).length_m)},
                     {"revision", provenance().revision}};
  return profiles;
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

// Identities that hold for the exact flow, each side computed by itself.
Json checks_json(const FinishedFlow& flow, double Q) {
  const FlowIntegrals sums = flow.solution.field.integrals({0, flow.drum.axis_offset});
  const double supplied = sums.given_side_power + sums.weight_power;
  return {{"Q_expected", flow.drum.expected_Q()},
          {"Q_relative_error", Q / flow.drum.expected_Q() - 1},
          {"surface_leak", sums.surface_leak},
          {"dissipation", sums.dissipation},
          {"wall_power", sums.given_side_power},
          {"weight_power", sums.weight_power},
          {"power_relative_error", sums.dissipation / supplied - 1},
          {"wall_torque", sums.given_side_torque},
          {"weight_torque", sums.weight_torque},
          {"torque_relative_error", sums.given_side_torque / -sums.weight_torque - 1},
          {"surface_force", sums.surface_force},
          {"surface_moment", sums.surface_moment}};
}

// The keys of rheology.toml; those of the logarithm come without their "law", as before there were others.
Json friction_json(const MeasuredFriction& mu) {
  struct Keys {
    Json operator()(const LogFriction& m) const {
      return {{"a", m.a}, {"b", m.b}, {"I_min", m.I_min}, {"I_max", m.I_max}};
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
  return {{"title", s.title},
          {"law", law},
          {"drum_radius", flow.drum.radius},
          {"rotation", flow.drum.rotation},
          {"surface_cell", s.mesh.surface_cell},
          {"surface_zone", s.mesh.surface_zone},
          {"levels", s.mesh.levels},
          {"corner_taper", s.boundary.corner_taper},
          {"surface_stiffness", s.boundary.surface_stiffness},
          {"regularisation_shear_rate", s.regularisation.shear_rate},
          {"regularisation_pressure", s.regularisation.pressure},
          {"tolerance", s.solver.tolerance},
          {"slice_width", slice_width(slice_of(s), flow.drum)},
          {"layer_thickness", s.output.layer_thickness},
          {"scales", to_json(scales_of(s))}};
}

Json phases_json(const FlowReport& report) {
  Json phases;
  for (const PhaseSeconds& phase : report.phases)
    phases[phase.name] = {{"seconds", phase.seconds}, {"times", phase.times}};
  return phases;
}

Json flow_json(const FinishedFlow& flow) {
  const MeshResult& result = flow.meshes.back();
  const FlowReport& report = flow.solution.report;
  const FlowIntegrals sums = flow.solution.field.integrals();
  Json content{{"format", "drumlin-flow-run-1"}, {"reduced", flow.reduced}};
  add_scalars(content, result.scalars);
  content["nu"] = flow.drum.nu;
  content["chord_offset"] = flow.drum.axis_offset;
  content["ill_posed_share"] = sums.ill_posed_area / sums.area;
  content["unknowns"] = result.unknowns;
  content["iterations"] = report.iterations;
  content["residual"] = report.residual;
  content["seconds"] = report.seconds;
  content["ranks"] = flow.ranks;
  content["phases"] = phases_json(report);
  content["checks"] = checks_json(flow, result.scalars.value("Q"));
  content["meshes"] = meshes_json(flow.meshes);
  content["mesh_change"] = mesh_change(flow.meshes);
  content["settings"] = settings_json(flow);
  content["provenance"] = to_json(provenance());
  return content;
}

}  // namespace

void write_iterations(const fs::path& file, const FlowReport& report) {
  std::string text = fmt::format("# drumlin-flow-iterations-1\n# converged = {}\n", report.converged);
  if (!report.failure.empty()) text += fmt::format("# failure = {}\n", report.failure);
  text +=
      "mesh,phase,shear_rate,pressure_share,iteration,residual,step_length,step_size,linear_residual,theta_"
      "deg,seconds\n";
  for (const IterationReport& line : report.history)
    fmt::format_to(std::back_inserter(text),
                   "{},{},{:.4g},{:.4g},{},{:.4e},{:.4g},{:.4e},{:.2e},{:.6f},{:.2f}\n", line.level,
                   line.phase, line.shear_rate, line.pressure_share, line.iteration, line.residual,
                   line.step_length, line.step_size, line.linear_residual,
                   line.theta * 180 / std::numbers::pi, line.seconds);
  replace_file(file, text);
}

void write_flow(const fs::path& folder, const FinishedFlow& flow) {
  const ProfileSet profiles = profiles_with_header(flow);
  write_maps(folder / "maps.csv", flow.solution.field, flow.drum, flow.scene.output.map_spacing,
             flow.reduced);
  flow.solution.field.write_vtu(folder / "flow.vtu");
  const Json content = flow_json(flow);
  if (!flow.solution.field.on_first_rank()) return;
  write_profiles(folder / "profiles.csv", profiles);
  // The figures read it under another name: flow.json itself says that all is there.
  const fs::path unfinished = folder / "flow.json.part";
  write_json(unfinished, content);
  draw_figures("flow_figures.py", {folder.string(), "--flow", unfinished.string()});
  write_json(folder / "flow.json", content);
  fs::remove(unfinished);
}

}  // namespace drumlin::apps
