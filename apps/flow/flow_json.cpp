#include "apps/flow/flow_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "apps/json/json_file.hpp"
#include "coupling/core/documents/json_numbers.hpp"
#include "coupling/core/law/ill_posed.hpp"
#include "coupling/core/results/run_records.hpp"

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

Json meshes_json(const std::vector<continuum::MeshResult>& meshes) {
  Json list = Json::array();
  for (const continuum::MeshResult& mesh : meshes) {
    Json entry{{"cells", mesh.cells}, {"unknowns", mesh.unknowns}};
    add_scalars(entry, mesh.scalars);
    list.push_back(std::move(entry));
  }
  return list;
}

// What the last halving of the cells changed: an upper estimate of what remains, as long as the changes
// shrink.
Json mesh_change(const std::vector<continuum::MeshResult>& meshes) {
  if (meshes.size() < 2) return nullptr;
  const ScalarSet &fine = meshes.back().scalars, &coarse = meshes[meshes.size() - 2].scalars;
  Json changes;
  for (const Scalar& scalar : fine.scalars)
    changes[scalar.name] =
        to_json(Scalar{scalar.name, std::abs(scalar.value - coarse.value(scalar.name)), {}});
  return changes;
}

// null where the order does not allow.
Json mesh_limit_json(const std::vector<continuum::MeshResult>& meshes) {
  if (meshes.size() < 3) return nullptr;
  Json content = Json::object();
  for (const continuum::ScalarLimit& s : continuum::limits_of(meshes))
    if (s.limit)
      content[s.name] = {{"order", s.limit->order}, {"value", s.limit->value}};
    else
      content[s.name] = nullptr;
  return content;
}

// Why there is no mesh_change: null says that nothing was computed, not that nothing changed.
Json mesh_change_missing(const FinishedFlow& flow) {
  if (flow.meshes.size() > 1) return nullptr;
  if (flow.asked.scene.time) return "a transient run stays on one mesh";
  if (flow.asked.scene.mesh.levels == 1) return "the scene has one mesh";
  return "started on the last mesh from another flow: no coarser one was solved";
}

Json scalars_json(const ScalarSet& scalars) {
  Json object = Json::object();
  add_scalars(object, scalars);
  return object;
}

Json closed_form_json(const FinishedFlow& flow) {
  if (!flow.findings.closed_form) return nullptr;
  const continuum::GapComparison& c = *flow.findings.closed_form;
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
          {"picard_updates", flow.solution.report.picard_updates},
          {"picard_change", flow.solution.report.picard_change}};
}

Json ill_posed_json(const FlowRequest& asked) {
  Json ranges = Json::array();
  if (asked.flow_case.problem.threshold_fluidity) return ranges;  // short waves see a fluidity that stays
  for (const InertialRange& range : ill_posed_intervals(asked.law)) ranges.push_back({range.from, range.to});
  return ranges;
}

struct JsonKeys {
  Json& object;
  void value(const std::string& key, const auto& value, const KeySpec&) { object[key] = value; }
  void value(const std::string& key, const std::optional<double>& value, const KeySpec&) {
    if (value) object[key] = *value;
  }
};

// The keys of rheology.toml.
Json friction_json(const FrictionLaw& mu) {
  return std::visit(
      []<class Law>(Law law) {
        Json json{{"law", Law::name}};
        JsonKeys keys{json};
        describe(keys, law);
        return json;
      },
      mu);
}

Json settings_json(const FinishedFlow& flow) {
  const continuum::FlowScene& s = flow.asked.scene;
  Json settings{{"title", s.title}, {"law", law_json(flow.asked.law)}};
  add_scalars(settings, flow.asked.flow_case.settings);
  const Json rest{{"surface_cell", s.mesh.surface_cell},
                  {"surface_zone", s.mesh.surface_zone},
                  {"levels", s.mesh.levels},
                  {"regularisation_shear_rate", s.regularisation.shear_rate},
                  {"regularisation_pressure", s.regularisation.pressure},
                  {"tolerance", s.solver.tolerance},
                  {"layer_thickness", s.output.layer_thickness},
                  {"scales", scales_of(s)}};
  settings.update(rest);
  return settings;
}

Json phases_json(const continuum::FlowReport& report) {
  Json phases;
  for (const continuum::PhaseSeconds& phase : report.phases)
    phases[phase.name] = {{"seconds", phase.seconds}, {"times", phase.times}};
  return phases;
}

// Terms that the scene neglects.
Json neglected_json(const FinishedFlow& flow) {
  const continuum::NeglectedTerms& rest = *flow.findings.neglected;
  const continuum::FlowEffects& effects = flow.asked.scene.effects;
  Json content = Json::object();
  if (!has_inertia(flow.asked.scene)) {
    content["inertia_rms"] = rest.inertia_rms;
    content["inertia_largest"] = rest.inertia_largest;
  }
  if (!effects.moving_surface) content["surface_height_rms"] = rest.surface_height_rms;
  if (!effects.wall_slip) content["wall_above_friction_0.95"] = rest.wall_friction;
  if (!effects.nonlocal && rest.nonlocal) content["nonlocal_1_d_rms"] = *rest.nonlocal;
  return content;
}

// Where the surface has gone, and what still presses on it.
Json surface_json(const FinishedFlow& flow) {
  const auto& shape = flow.solution.field.surface();
  if (!shape) return nullptr;
  std::vector<double> x, z;
  constexpr int points = 101;
  for (int i = 0; i < points; ++i) {
    const continuum::Vec2 p = continuum::surface_point(*shape, -1 + 2.0 * i / (points - 1));
    x.push_back(p.x);
    z.push_back(p.z);
  }
  Json slopes = Json::object();
  for (const double length : {10.0, 20.0, 30.0})
    slopes[fmt::format("{:g}", length)] =
        (flow.solution.field.theta() + continuum::mean_slope(*shape, length)) * 180 / std::numbers::pi;
  Json steps = Json::array();
  for (const continuum::SurfaceStepReport& step : flow.solution.report.surface_steps)
    steps.push_back({{"mesh", step.level},
                     {"share", step.share},
                     {"height", step.height},
                     {"pressed_rms", step.rms},
                     {"pressed_resolved", step.resolved},
                     {"pressed_largest", step.largest},
                     {"iterations", step.iterations}});
  return {{"x", x},
          {"z", z},
          {"z_middle", continuum::height(*shape, 0)},
          {"slope_deg", slopes},
          {"steps", steps}};
}

Json sensitivity_json(const FinishedFlow& flow) {
  if (flow.sensitivities.empty()) return nullptr;
  Json list = Json::array();
  for (const continuum::Sensitivity& s : flow.sensitivities) {
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
  const continuum::LawBand& band = flow.law_band;
  if (band.draws == 0) return nullptr;
  Json content{{"draws", band.draws},
               {"found", band.found},
               {"iterations", band.iterations},
               {"seconds", band.seconds}};
  content["profile"] = to_json(Scalar{"profile", band.profile, {}});
  content["scalars"] = scalars_json(band.scalars);
  return content;
}

Json accuracy_json(const FinishedFlow& flow) {
  if (flow.accuracy.scalars.empty()) return nullptr;
  Json scalars = Json::object(), halvings = Json::object();
  for (const continuum::ScalarAccuracy& a : flow.accuracy.scalars) {
    Json entry{{"value", a.value}, {"error", number_or_null(a.error())}};
    entry["dominant"] = a.dominant().empty() ? Json(nullptr) : Json(a.dominant());
    for (const continuum::ErrorPart& part : a.parts) entry[part.source] = number_or_null(part.error);
    entry["p_min_20_percent"] = number_or_null(a.by_p_min);
    entry["law"] = number_or_null(a.by_law);
    scalars[a.name] = std::move(entry);
  }
  for (const continuum::Halving& h : flow.accuracy.halvings)
    halvings[h.source] = {{"set", h.changes}, {"cpu_seconds", h.cpu_seconds}};
  return {{"scalars", scalars}, {"halving", halvings}, {"cpu_seconds", flow.cpu_seconds}};
}

Json rank_costs_json(const FinishedFlow& flow) {
  Json list = Json::array();
  for (std::size_t rank = 0; rank < flow.rank_cpu_seconds.size(); ++rank)
    list.push_back(
        {{"cpu_seconds", flow.rank_cpu_seconds[rank]}, {"peak_memory_mb", flow.rank_peak_memory_mb[rank]}});
  return list;
}

}  // namespace

Json law_json(const RheologyFit& fit) {
  Json law = friction_json(fit.mu);
  law["nu"] = fit.nu;
  law["fitted_on"] = fit.fitted_on;
  if (fit.k) law["k"] = {{"I", fit.k->I}, {"k", fit.k->k}};
  return law;
}

Json flow_json(const FinishedFlow& flow) {
  const continuum::MeshResult& result = flow.meshes.back();
  const continuum::FlowReport& report = flow.solution.report;
  Json content{{"format", FlowRecord::format}, {"reduced", flow.asked.reduced()}};
  content["geometry"] = name_of(flow.asked.flow_case.geometry);
  add_scalars(content, result.scalars);
  add_scalars(content, flow.asked.flow_case.given);
  content["ill_posed_share"] = flow.findings.ill_posed_share();
  content["beyond_law_share"] = flow.findings.beyond_law_share();
  content["ill_posed_I"] = ill_posed_json(flow.asked);
  if (flow.plain) content[flow.asked.law.k ? "without_k" : "without_nonlocal"] = plain_json(flow);
  content["unknowns"] = result.unknowns;
  content["iterations"] = report.iterations;
  content["start"] = report.start;
  content["added_meshes"] = result.level + 1 - flow.asked.scene.mesh.levels;
  content["missed"] = flow.missed;
  if (flow.asked.scene.time)
    content["time"] = {{"step_s", flow.asked.scene.time->step_s},
                       {"steps", flow.asked.scene.time->steps},
                       {"end_s", flow.asked.scene.time->steps * flow.asked.scene.time->step_s},
                       {"ramp_s", flow.asked.scene.time->ramp_s}};
  content["residual"] = report.residual;
  content["seconds"] = report.seconds;
  content["cpu_seconds"] = flow.cpu_seconds;
  content["ranks"] = flow.ranks;
  content["rank_costs"] = rank_costs_json(flow);
  content["phases"] = phases_json(report);
  content["checks"] = scalars_json(flow.findings.checks);
  if (flow.findings.neglected) content["neglected"] = neglected_json(flow);
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
  content["provenance"] = provenance();
  add_accepted_edits(content["provenance"], flow.asked.accepted);
  return content;
}

}  // namespace drumlin::apps
